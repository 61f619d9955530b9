// SPDX-License-Identifier: MIT
// Cost of one update of the objects aggregator: as many cars as the argument says, 10 m apart, all seen; and
// what a lidar sweep costs as a view of what hides what.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "atlas/fusion/box_measurement.hpp"
#include "atlas/fusion/object_tracker.hpp"
#include "atlas/fusion/range_view.hpp"

namespace {

using namespace atlas;

Scan scanOf(int cars, int update, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 0.05);
  Scan scan;
  scan.stamp = (1000 + update) * 100 * kMillisecond;
  scan.input = "obstacles";
  scan.detectability = [](const TrackShape&) { return 0.8; };
  for (int i = 0; i < cars; ++i) {
    const double speed = i % 3 == 0 ? 0.0 : 8.0;
    const Eigen::Vector3d center(10.0 * (i % 20) + 0.1 * speed * update + noise(random),
                                 10.0 * (i / 20) + noise(random), 0.8);
    scan.measurements.push_back(std::make_unique<SeenBox>(
        Obstacle{center, 0.0, {4.4, 1.8, 1.5}, 100}, Eigen::Vector3d(-10.0, -10.0, 1.8), SeenBox::Hidden{}));
  }
  return scan;
}

void objectsUpdate(benchmark::State& state) {
  std::mt19937 random(1);
  ObjectTracker tracker{TrackerParams{}};
  Counters counters;
  int update = 0;
  for (; update < 20; ++update)
    tracker.update(scanOf(static_cast<int>(state.range(0)), update, random), counters);
  for (auto _ : state) {
    state.PauseTiming();
    const Scan scan = scanOf(static_cast<int>(state.range(0)), update++, random);
    state.ResumeTiming();
    tracker.update(scan, counters);
    benchmark::DoNotOptimize(tracker.report(scan.stamp));
  }
  state.counters["tracks"] = static_cast<double>(tracker.tracks().size());
}
BENCHMARK(objectsUpdate)->Arg(20)->Arg(200)->Unit(benchmark::kMillisecond);

void rangeView(benchmark::State& state) {
  auto sweep = std::make_shared<Sweep>();
  for (int i = 0; i < 70'000; ++i) {
    const double azimuth = -2.0 * M_PI * (i / 32) / 2188.0,
                 elevation = (-30.0 + 1.3 * (i % 32)) * M_PI / 180.0;
    LidarPoint p;
    p.x = static_cast<float>(20.0 * std::cos(azimuth));
    p.y = static_cast<float>(20.0 * std::sin(azimuth));
    p.z = static_cast<float>(20.0 * std::tan(elevation));
    sweep->points.push_back(p);
  }
  BatchedSweep batched;
  batched.sweep = sweep;
  batched.batches.push_back({0, 70'000, 0, {}});
  for (auto _ : state) benchmark::DoNotOptimize(RangeView(batched));
}
BENCHMARK(rangeView)->Unit(benchmark::kMillisecond);

}  // namespace
