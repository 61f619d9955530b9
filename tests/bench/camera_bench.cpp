// SPDX-License-Identifier: MIT
// Speed of the depth image: all points of a window transformed, culled, distorted and z-buffered into a 640 x
// 512 image.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "atlas/camera/depth_buffer.hpp"
#include "atlas/camera/intrinsics_cache.hpp"

namespace {

using namespace atlas;

// The thermal camera of the Brno Urban Dataset.
CameraInfo thermalInfo() {
  CameraInfo info;
  info.width = 640;
  info.height = 512;
  info.distortion_model = "plumb_bob";
  info.distortion = {-0.292186, 0.109670, -0.00170026, -0.00301853, -0.0294095};
  info.K = {526.4079, 0, 328.7302, 0, 526.1605, 266.0666, 0, 0, 1};
  return info;
}

// 32 beams all around, 100 batches a sweep, as an HDL-32E in a street of 10..40 m.
BatchedSweep makeSweep(std::size_t count) {
  auto sweep = std::make_shared<Sweep>();
  sweep->points.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(count);
    const double elevation = (-30.67 + 1.33 * static_cast<double>(i % 32)) * M_PI / 180.0;
    const double range = 25.0 + 15.0 * std::sin(7.0 * azimuth);
    sweep->points[i].x = static_cast<float>(range * std::cos(elevation) * std::cos(azimuth));
    sweep->points[i].y = static_cast<float>(range * std::cos(elevation) * std::sin(azimuth));
    sweep->points[i].z = static_cast<float>(range * std::sin(elevation));
  }
  BatchedSweep batched;
  batched.sweep = sweep;
  for (std::size_t b = 0; b < 100; ++b) {
    Batch batch;
    batch.first = static_cast<std::uint32_t>(count * b / 100);
    batch.count = static_cast<std::uint32_t>(count * (b + 1) / 100 - batch.first);
    batched.batches.push_back(batch);
  }
  return batched;
}

/// What the depth stage does with the points.
cv::Mat render(DepthBuffer& buffer, double focal_px) {
  const double line_gap_px = focal_px * 1.5 * M_PI / 180.0;
  buffer.removeInvisible({line_gap_px, 0.03, 0.15});
  buffer.fill({focal_px, 0.3, line_gap_px, 0.12});
  return buffer.image();
}

void depthImage(benchmark::State& state) {
  const std::size_t sweeps = static_cast<std::size_t>(state.range(0));
  const CompactSweepPtr sweep = compacted(makeSweep(70000));
  IntrinsicsCache cache(0.5, 100.0);
  const Intrinsics& intrinsics = cache.of(thermalInfo()).value();
  Pose T_camera_map;  // optical frame of a camera that looks along x
  T_camera_map.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5).conjugate();
  std::size_t seen = 0;
  for (auto _ : state) {
    DepthBuffer buffer(640, 512);
    seen = 0;
    for (std::size_t i = 0; i < sweeps; ++i) {
      intrinsics.projector.projectSweep(*sweep, T_camera_map, [&](const ProjectedPoint& point) {
        buffer.add(point);
        ++seen;
      });
    }
    benchmark::DoNotOptimize(render(buffer, intrinsics.model.fx()).data);
  }
  state.counters["points"] = static_cast<double>(70000 * sweeps);
  state.counters["seen"] = static_cast<double>(seen);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * 70000 * sweeps));
}
BENCHMARK(depthImage)->Arg(10)->Arg(20)->Unit(benchmark::kMillisecond);

}  // namespace
