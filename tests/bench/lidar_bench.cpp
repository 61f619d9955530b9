// SPDX-License-Identifier: MIT
// Speed of the de-skew: a sweep of an HDL-32E cut into batches with poses, and all its points carried into
// map.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "atlas/lidar/batched_points.hpp"
#include "atlas/lidar/batching.hpp"

namespace {

using namespace atlas;

constexpr int kPoints = 69440;  // 2170 columns of 32 beams
constexpr Stamp kStart = 1'500'000'000'000'000'000;

SweepPtr sweep() {
  auto result = std::make_shared<Sweep>();
  result->stamp = kStart + 200 * kMillisecond;
  result->points.resize(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    LidarPoint& point = result->points[static_cast<std::size_t>(i)];
    const double azimuth = -2.0 * M_PI * i / kPoints;
    point.x = static_cast<float>(20.0 * std::cos(azimuth));
    point.y = static_cast<float>(20.0 * std::sin(azimuth));
    point.z = static_cast<float>(0.1 * (i % 32));
    point.time = static_cast<float>(0.1 * i / kPoints - 0.1);
  }
  return result;
}

/// Poses at 400 Hz of a car at 10 m/s in a turn of 0.5 rad/s.
Trajectory trajectory() {
  Trajectory result;
  for (int i = 0; i < 200; ++i) {
    const double t = i / 400.0, yaw = 0.5 * t;
    result.push({kStart + fromSeconds(t),
                 {fromRollPitchYaw({0.01, 0.02, yaw}),
                  Eigen::Vector3d(20.0 * std::sin(yaw), 20.0 * (1.0 - std::cos(yaw)), 0.0)}});
  }
  return result;
}

void deskewIntoMap(benchmark::State& state) {
  const SweepPtr points = sweep();
  const Trajectory poses = trajectory();
  const Pose T_imu_lidar{fromRollPitchYaw({0.1, 0.0, 3.1}), Eigen::Vector3d(0.17, 0.48, 0.15)};
  const int batches = static_cast<int>(state.range(0));
  for (auto _ : state) {
    const auto batched = cutIntoBatches(points, *spanOf(*points), batches, poses, T_imu_lidar);
    benchmark::DoNotOptimize(deskewed(*batched).points.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * kPoints);
}
BENCHMARK(deskewIntoMap)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
