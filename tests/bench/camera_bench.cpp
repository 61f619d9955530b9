// SPDX-License-Identifier: MIT
// Speed of the cameras: all points of a window transformed, culled, distorted and z-buffered, hidden ones
// removed and gaps filled, for 640 x 512 and 1920 x 1200 pixels; and the distance of 20 detections beyond the
// projection.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "atlas/camera/depth_buffer.hpp"
#include "atlas/camera/foreground.hpp"
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
DepthBuffer::Images render(DepthBuffer& buffer, double focal_px) {
  const double line_gap_px = focal_px * 1.5 * M_PI / 180.0;
  buffer.removeInvisible({line_gap_px, 0.03, 0.15});
  return buffer.takeFilled({focal_px, 0.3, line_gap_px, 0.12});
}

// The left front camera of the Brno Urban Dataset.
CameraInfo rgbInfo() {
  CameraInfo info;
  info.width = 1920;
  info.height = 1200;
  info.distortion_model = "plumb_bob";
  info.distortion = {-0.172454, 0.112390, -0.000152537, 0.000384873, -0.0207703};
  info.K = {1376.3974, 0, 959.2366, 0, 1377.1722, 576.7434, 0, 0, 1};
  return info;
}

/// Optical frame of a camera that looks along x.
Pose forwardCamera() {
  Pose T_camera_map;
  T_camera_map.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5).conjugate();
  return T_camera_map;
}

void depthImageOf(benchmark::State& state, const CameraInfo& info) {
  const std::size_t sweeps = static_cast<std::size_t>(state.range(0));
  const CompactSweepPtr sweep = compacted(makeSweep(70000));
  IntrinsicsCache cache(0.5, 100.0);
  const Intrinsics& intrinsics = cache.of(info).value();
  const Pose T_camera_map = forwardCamera();
  DepthBuffer buffer(intrinsics.model.width(), intrinsics.model.height());
  std::size_t seen = 0;
  for (auto _ : state) {
    seen = 0;
    for (std::size_t i = 0; i < sweeps; ++i) {
      intrinsics.projector.projectSweep(*sweep, T_camera_map, [&](const ProjectedPoint& point) {
        buffer.add(point, i + 4 > sweeps);
        ++seen;
      });
    }
    benchmark::DoNotOptimize(render(buffer, intrinsics.model.fx()).depth.data);
  }
  state.counters["points"] = static_cast<double>(70000 * sweeps);
  state.counters["seen"] = static_cast<double>(seen);
  state.counters["s_per_point_in_view"] = benchmark::Counter(
      static_cast<double>(seen), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * 70000 * sweeps));
}
void depthImage(benchmark::State& state) { depthImageOf(state, thermalInfo()); }
BENCHMARK(depthImage)->Arg(10)->Arg(20)->Unit(benchmark::kMillisecond);
// Into an image that is there: what a point costs.
void pointsIntoRgb(benchmark::State& state) {
  const CompactSweepPtr sweep = compacted(makeSweep(70000));
  IntrinsicsCache cache(0.5, 100.0);
  const Intrinsics& intrinsics = cache.of(rgbInfo()).value();
  DepthBuffer buffer(intrinsics.model.width(), intrinsics.model.height());
  std::size_t seen = 0;
  for (auto _ : state) {
    seen = 0;
    intrinsics.projector.projectSweep(*sweep, forwardCamera(), [&](const ProjectedPoint& point) {
      buffer.add(point);
      ++seen;
    });
  }
  state.counters["s_per_point_in_view"] = benchmark::Counter(
      static_cast<double>(seen), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(pointsIntoRgb)->Unit(benchmark::kMillisecond);
void depthImageOfRgb(benchmark::State& state) { depthImageOf(state, rgbInfo()); }
BENCHMARK(depthImageOfRgb)->Arg(20)->Unit(benchmark::kMillisecond);

// 20 boxes of 100 x 100 px over the image, each with the points that a window of 0.6 s puts there.
void distancesOf20Detections(benchmark::State& state) {
  const CompactSweepPtr sweep = compacted(makeSweep(70000));
  IntrinsicsCache cache(0.1, 80.0);
  const Intrinsics& intrinsics = cache.of(rgbInfo()).value();
  std::vector<Detection2d> boxes;
  for (int i = 0; i < 20; ++i) {
    const double u = 80.0 + 340.0 * (i % 5), v = 450.0 + 120.0 * (i / 5);
    boxes.push_back({u, v, u + 100.0, v + 100.0, 2, 0.9});
  }
  std::vector<std::vector<BoxPoint>> points(boxes.size());
  for (int i = 0; i < 12; ++i) {
    intrinsics.projector.projectSweep(*sweep, forwardCamera(), [&](const ProjectedPoint& p) {
      for (std::size_t b = 0; b < boxes.size(); ++b) {
        const Detection2d& box = boxes[b];
        if (p.u > box.x_min && p.u < box.x_max && p.v > box.y_min && p.v < box.y_max)
          points[b].push_back({p.u, p.v, p.depth_m, 0.05F * static_cast<float>(i - 10)});
      }
    });
  }
  std::size_t in_boxes = 0;
  for (const auto& list : points) in_boxes += list.size();
  for (auto _ : state) {
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      std::vector<BoxPoint> copy = points[b];
      benchmark::DoNotOptimize(findForeground(boxes[b], copy, {}));
    }
  }
  state.counters["points"] = static_cast<double>(in_boxes);
}
BENCHMARK(distancesOf20Detections)->Unit(benchmark::kMillisecond);

}  // namespace
