// SPDX-License-Identifier: MIT
// Speed of the occupancy filter on 200 x 200 cells and of everything around it, in a street with moving cars,
// seen by two four-layer lidars and a stereo camera at 20 Hz. Scans and grids are made beforehand.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "atlas/grid/fast_clustering.hpp"
#include "atlas/grid/occupancy_chain.hpp"
#include "scene.hpp"

namespace {

using namespace atlas;
using namespace atlas::grid_scene;

constexpr Stamp kStart = 1'500'000'000 * kSecond;
constexpr int kFrames = 20;
constexpr Stamp kStep = 50 * kMillisecond;

Scene street() {
  Scene scene;
  scene.actors.push_back({"crossing", 4.4, 1.8, 0.15, 1.5, drives(18.0, -10.0, M_PI / 2.0, 7.3)});
  scene.actors.push_back({"leaving", 4.4, 1.8, 0.15, 1.5, drives(9.0, -1.5, 0.0, 6.1)});
  scene.actors.push_back({"slow", 4.4, 1.8, 0.15, 1.5, drives(12.0, 5.0, 0.0, 1.5)});
  scene.actors.push_back({"pedestrian", 0.5, 0.5, 0.0, 1.75, drives(11.0, -5.0, M_PI / 2.0, 1.4)});
  scene.actors.push_back({"wall", 26.0, 0.3, 0.0, 2.5, stands(22.0, 9.5)});
  scene.actors.push_back({"house", 0.3, 20.0, 0.0, 2.5, stands(34.0, 0.0)});
  scene.ego = drives(0.0, 0.0, 0.0, 5.0);
  return scene;
}

std::vector<OccupancyInput> makeInputs() {
  const Scene scene = street();
  StereoEye eye;
  std::vector<OccupancyInput> inputs;
  for (int k = 0; k < kFrames; ++k) {
    const double t = 0.05 * k;
    OccupancyInput input;
    input.stamp = kStart + k * kStep;
    input.T_map_imu = egoPose(scene, t);
    input.motion = egoOdometry(scene, t, input.stamp);
    input.lidars = {scanOf(scene, SensorSet{}, 0, t, input.stamp),
                    scanOf(scene, SensorSet{}, 1, t, input.stamp)};
    input.grids = {eye.look(scene, SensorSet{}, t, input.stamp)};
    inputs.push_back(std::move(input));
  }
  return inputs;
}

/// The same frames again and again; the filter begins anew with each round so that stamps rise.
struct Frames {
  std::vector<OccupancyInput> inputs = makeInputs();
  std::vector<GridGeometry> geometries;
  std::vector<std::vector<float>> evidence;
};

const Frames& frames() {
  static const std::unique_ptr<const Frames> made = [] {
    auto f = std::make_unique<Frames>();
    RowWorkers one(1);
    BeamModel model{BeamParams{}};
    PooledGrid pooled(Pooling::kProduct);
    GridParams grid;
    grid.ahead_m = 20.0;
    for (const OccupancyInput& input : f->inputs) {
      f->geometries.push_back(placeGrid(grid, input.T_map_imu.translation.head<2>(), 0.0));
      pooled.reset(f->geometries.back().cells());
      for (const LidarLayers& lidar : input.lidars)
        pooled.add(model.evaluate(lidar, RoadPlane{}, f->geometries.back(), one).occupied);
      f->evidence.push_back(pooled.result());
    }
    return f;
  }();
  return *made;
}

void filterUpdate(benchmark::State& state, const FilterParams& params) {
  auto filter = makeFilter(params);
  RowWorkers workers(static_cast<int>(state.range(0)));
  const Frames& f = frames();
  int k = 0;
  for (auto _ : state) {
    filter->update(f.geometries[k], f.evidence[k], 0.05, workers);
    benchmark::DoNotOptimize(filter->cells().occupied.data());
    k = (k + 1) % kFrames;
  }
}
void BM_LatticeUpdate(benchmark::State& state) { filterUpdate(state, {}); }
void BM_Tay2008Update(benchmark::State& state) {
  FilterParams params;
  params.mode = FilterMode::kTay2008;
  filterUpdate(state, params);
}
BENCHMARK(BM_LatticeUpdate)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(BM_Tay2008Update)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// With 81 velocities (levels 2, 4, 6, 8 m/s) as published lattices have, for comparison.
void BM_LatticeUpdate81(benchmark::State& state) {
  FilterParams params;
  params.levels_mps = {2.0, 4.0, 6.0, 8.0};
  filterUpdate(state, params);
}
BENCHMARK(BM_LatticeUpdate81)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// One lidar with four layers.
void BM_LidarGrid(benchmark::State& state) {
  BeamModel model{BeamParams{}};
  RowWorkers workers(static_cast<int>(state.range(0)));
  const Frames& f = frames();
  int k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        model.evaluate(f.inputs[k].lidars[0], RoadPlane{}, f.geometries[k], workers).occupied.data());
    k = (k + 1) % kFrames;
  }
}
BENCHMARK(BM_LidarGrid)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void BM_FastClusteringAndTracking(benchmark::State& state) {
  auto filter = makeFilter(FilterParams{});
  RowWorkers one(1);
  const Frames& f = frames();
  for (int k = 0; k < kFrames; ++k) filter->update(f.geometries[k], f.evidence[k], 0.05, one);
  const std::vector<float> tops(f.geometries.back().cells(), 1.0F);
  ClusterTracker tracker{ClusterTrackParams{}};
  Counters counters;
  Stamp stamp = kStart;
  for (auto _ : state) {
    tracker.update({stamp, f.geometries.back(), filter->cells(), f.evidence.back(), tops, {0.0, 0.0}, 0.0},
                   counters);
    stamp += kStep;
  }
}
BENCHMARK(BM_FastClusteringAndTracking)->Unit(benchmark::kMillisecond);

/// Two lidars, stereo grid, filter, tracking and risk.
void BM_WholeChain(benchmark::State& state) {
  OccupancyParams params = paramsFor(FilterMode::kLattice);
  params.threads = static_cast<int>(state.range(0));
  OccupancyChain chain(params);
  Counters counters;
  const Frames& f = frames();
  int k = 0;
  Stamp round = 0;
  for (auto _ : state) {
    OccupancyInput input = f.inputs[k];
    input.stamp += round;
    benchmark::DoNotOptimize(chain.update(input, counters));
    if (++k < kFrames) continue;
    k = 0;
    round += kFrames * kStep;
  }
}
BENCHMARK(BM_WholeChain)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
