// SPDX-License-Identifier: MIT
// Speed of ground and obstacles on a window of two HDL-32E sweeps (140 000 points) in a street with houses,
// parked cars, people and poles, rays cast against boxes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "atlas/lidar/clusters.hpp"
#include "atlas/lidar/ground.hpp"
#include "atlas/lidar/line_stage.hpp"
#include "atlas/lidar/obstacle_stage.hpp"

namespace {

using namespace atlas;

constexpr int kColumns = 2188, kLasers = 32, kBatches = 100;
constexpr double kDegree = M_PI / 180.0;
constexpr Stamp kStamp = 1'500'000'000'000'000'000;

struct Box {
  Eigen::Vector3d low, high;
};

std::vector<Box> street() {
  std::vector<Box> boxes = {{{-80, 10.5, -1}, {80, 20, 12}}, {{-80, -20, -1}, {80, -10.5, 12}}};
  for (int i = -12; i <= 12; ++i) {
    const double x = 6.3 * i, side = i % 2 == 0 ? 5.0 : -6.8;
    boxes.push_back({{x, side, 0.2}, {x + 4.2, side + 1.8, 0.9}});              // a car's body
    boxes.push_back({{x + 0.9, side + 0.1, 0.9}, {x + 3.2, side + 1.7, 1.5}});  // its cabin
    boxes.push_back({{x + 5.2, 7.5, 0.0}, {x + 5.35, 7.65, 6.0}});              // a pole
    boxes.push_back({{x + 2.0, -8.6, 0.0}, {x + 2.44, -8.2, 1.7}});             // a person
  }
  return boxes;
}

/// Range to the ground at z = 0 or the nearest box; infinity when the beam meets nothing within 100 m.
double cast(const Eigen::Vector3d& from, const Eigen::Vector3d& along, const std::vector<Box>& boxes) {
  double range = along.z() < 0.0 ? -from.z() / along.z() : std::numeric_limits<double>::infinity();
  for (const Box& box : boxes) {
    double enter = 0.0, leave = range;
    for (int axis = 0; axis < 3 && enter <= leave; ++axis) {
      const double a = (box.low[axis] - from[axis]) / along[axis],
                   b = (box.high[axis] - from[axis]) / along[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter <= leave) range = enter;
  }
  return range <= 100.0 ? range : std::numeric_limits<double>::infinity();
}

BatchedSweepPtr sweepFrom(const Eigen::Vector3d& place, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.02);
  const std::vector<Box> boxes = street();
  auto sweep = std::make_shared<Sweep>();
  sweep->stamp = kStamp;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = -2.0 * M_PI * column / kColumns;
    for (int laser = 0; laser < kLasers; ++laser) {
      const double elevation = (-30.67 + 1.3333 * laser) * kDegree;
      const Eigen::Vector3d along(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double range = cast(place, along, boxes) + noise(random);
      LidarPoint p;
      p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
      if (std::isfinite(range)) {
        p.x = static_cast<float>(range * along.x());
        p.y = static_cast<float>(range * along.y());
        p.z = static_cast<float>(range * along.z());
      }
      p.ring = static_cast<std::uint16_t>(laser);
      sweep->points.push_back(p);
    }
  }
  auto batched = std::make_shared<BatchedSweep>();
  batched->stamp = kStamp;
  batched->sweep = sweep;
  const auto size = static_cast<std::uint32_t>(sweep->points.size());
  for (std::uint32_t i = 0; i < kBatches; ++i) {
    const std::uint32_t first = size / kBatches * i,
                        last = i + 1 == kBatches ? size : size / kBatches * (i + 1);
    batched->batches.push_back({first, last - first, kStamp, {Eigen::Quaterniond::Identity(), place}});
  }
  return batched;
}

std::vector<BatchedSweepPtr> window() {
  return {sweepFrom({0.2, 0.5, 1.9}, 1), sweepFrom({0.2, -0.5, 1.9}, 2)};
}

void groundAndObstacles(benchmark::State& state) {
  const std::vector<BatchedSweepPtr> sweeps = window();
  std::size_t points = 0, obstacles = 0;
  for (const auto& sweep : sweeps) points += sweep->sweep->points.size();
  for (auto _ : state) {
    Counters counters;
    const Obstacles found = findObstacles(sweeps, {0.0, 0.0, 1.0}, kStamp, {}, counters);
    obstacles = found.obstacles.size();
    benchmark::DoNotOptimize(found.obstacles.data());
  }
  state.counters["points"] = static_cast<double>(points);
  state.counters["obstacles"] = static_cast<double>(obstacles);
}
BENCHMARK(groundAndObstacles)->Unit(benchmark::kMillisecond);

void linesOfASweep(benchmark::State& state) {
  const BatchedSweepPtr sweep = window().front();
  std::size_t lines = 0;
  for (auto _ : state) {
    const Lines found = findLines(*sweep, {});
    lines = found.lines.size();
    benchmark::DoNotOptimize(found.lines.data());
  }
  state.counters["points"] = static_cast<double>(sweep->sweep->points.size());
  state.counters["lines"] = static_cast<double>(lines);
}
BENCHMARK(linesOfASweep)->Unit(benchmark::kMillisecond);

std::vector<LidarPoint> windowInMap() {
  std::vector<LidarPoint> points;
  for (const auto& sweep : window()) {
    forEachPoint(*sweep, [&](std::size_t i, const Batch& batch) {
      LidarPoint p = sweep->sweep->points[i];
      const Eigen::Vector3d q = batch.T_map_lidar * Eigen::Vector3d(p.x, p.y, p.z);
      if (!(q.head<2>().norm() <= 40.0)) return;
      p.x = static_cast<float>(q.x());
      p.y = static_cast<float>(q.y());
      p.z = static_cast<float>(q.z());
      points.push_back(p);
    });
  }
  return points;
}

void groundAlone(benchmark::State& state) {
  const std::vector<LidarPoint> points = windowInMap();
  for (auto _ : state) {
    const GroundGrid grid(points, {0.0, 0.0, 1.0}, {});
    benchmark::DoNotOptimize(grid.believedCells());
  }
}
BENCHMARK(groundAlone)->Unit(benchmark::kMillisecond);

void clustersAlone(benchmark::State& state) {
  std::vector<LidarPoint> raised;
  for (const LidarPoint& p : windowInMap()) {
    if (p.z > 0.25F && p.z < 4.0F) raised.push_back(p);
  }
  for (auto _ : state) benchmark::DoNotOptimize(findClusters(raised, {0.0, 0.0, 1.0}, {}).data());
  state.counters["points"] = static_cast<double>(raised.size());
}
BENCHMARK(clustersAlone)->Unit(benchmark::kMillisecond);

}  // namespace
