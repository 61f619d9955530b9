// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>

#include "scenario_parts.hpp"

namespace atlas::grid_scene {
namespace {

std::uint64_t mixed(std::uint64_t hash, const std::vector<float>& values) {
  for (const float value : values) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001B3ULL;
  }
  return hash;
}

std::uint64_t hashOf(const std::vector<Step>& steps) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const Step& step : steps) {
    const CellEstimates& cells = *step.frame->cells;
    for (const auto* field : {&cells.occupied, &cells.unknown, &cells.static_share, &cells.vx_mps,
                              &cells.vy_mps, &cells.var_xx, &cells.saturation})
      hash = mixed(hash, *field);
    for (const Object& object : step.frame->objects.objects)
      hash = mixed(hash, {static_cast<float>(object.id), static_cast<float>(object.position.x()),
                          static_cast<float>(object.velocity_mps.y())});
    if (step.frame->risk) hash = mixed(hash, {static_cast<float>(step.frame->risk->total)});
  }
  return hash;
}

}  // namespace

/// The stereo camera sees something that is not there, the lidars look through it.
std::vector<Figure> conflict(FilterMode mode, unsigned seed) {
  Scene scene;
  scene.actors.push_back({"car", 4.4, 1.8, 0.0, 1.5, stands(32.0, 0.0)});
  StereoEye eye;
  std::vector<Figure> figures;
  for (const Pooling pooling : {Pooling::kProduct, Pooling::kLog, Pooling::kLinear}) {
    OccupancyParams params = paramsFor(mode);
    params.pooling = pooling;
    OccupancyChain chain(params);
    Counters counters;
    const SensorSet sensors = options(mode, seed).sensors;
    double brier = 0.0, count = 0.0;
    for (int k = 0; k < 20; ++k) {
      OccupancyInput input;
      input.stamp = (1'500'000'000LL + seed) * kSecond + k * 50 * kMillisecond;
      input.T_map_imu = egoPose(scene, 0.0);
      input.lidars = {scanOf(scene, sensors, 0, 0.0, input.stamp),
                      scanOf(scene, sensors, 1, 0.0, input.stamp)};
      PlacedGrid placed = eye.look(scene, sensors, 0.0, input.stamp);
      auto wrong = std::make_shared<SensorGrid>(*placed.grid);
      for (int row = 95; row < 105; ++row) {
        for (int column = 85; column < 95; ++column)  // 17 to 19 m before the camera
          wrong->occupied[static_cast<std::size_t>(row * wrong->columns + column)] = 0.9F;
      }
      placed.grid = wrong;
      input.grids = {placed};
      const OccupancyFramePtr frame = chain.update(input, counters);
      forCells(*frame, [&](std::size_t i, const Eigen::Vector2d& place) {
        if (k < 5 || std::abs(place.y()) > 0.8 || place.x() < 19.2 || place.x() > 20.4) return;
        brier += std::pow(frame->cells->occupied[i], 2);
        count += 1.0;
      });
    }
    const std::string name = pooling == Pooling::kProduct ? "product"
                             : pooling == Pooling::kLog   ? "log pool"
                                                          : "linear pool";
    figures.push_back(told("Brier score where stereo errs, " + name, brier / count));
  }
  return figures;
}

/// Lidar at 12.5 Hz, stereo at 20 Hz, 30 ms of jitter, and a second without lidar.
std::vector<Figure> unevenTimes(FilterMode mode, unsigned seed) {
  Scene scene;
  scene.actors.push_back({"car", 4.4, 1.8, 0.15, 1.5, drives(10.0, 1.0, 0.0, 1.5)});
  OccupancyChain chain(paramsFor(mode));
  Counters counters;
  StereoEye eye;
  const SensorSet sensors = options(mode, seed).sensors;
  std::vector<std::pair<double, bool>> events;  // time, lidar
  for (int k = 0; k < 44; ++k) {
    const double t = 0.08 * k;
    if (t < 1.5 || t > 2.5) events.emplace_back(t + 0.03 * std::sin(7.0 * k + seed), true);
  }
  for (int k = 0; k < 70; ++k)
    events.emplace_back(0.05 * k + 0.03 * std::sin(5.0 * k + 2.0 * seed) + 0.001, false);
  std::sort(events.begin(), events.end());
  double found = 0.0, frames = 0.0, outage_found = 0.0, outage = 0.0;
  for (const auto& [t, lidar] : events) {
    OccupancyInput input;
    input.stamp = 1'500'000'000 * kSecond + fromSeconds(t);
    input.T_map_imu = egoPose(scene, t);
    if (lidar)
      input.lidars = {scanOf(scene, sensors, 0, t, input.stamp), scanOf(scene, sensors, 1, t, input.stamp)};
    if (!lidar) input.grids = {eye.look(scene, sensors, t, input.stamp)};
    Step step;
    step.t_s = t;
    step.frame = chain.update(input, counters);
    assignTracks(scene, step);
    if (t < 0.8) continue;
    found += step.of_actor[0].empty() ? 0.0 : 1.0;
    frames += 1.0;
    if (t < 1.6 || t > 2.5) continue;
    outage_found += step.of_actor[0].empty() ? 0.0 : 1.0;
    outage += 1.0;
  }
  return {
      atLeast("car found at uneven times", 100.0 * found / frames, 90.0, "% of updates"),
      atLeast("car found while the lidars are silent", 100.0 * outage_found / outage, 90.0, "% of updates")};
}

/// The same bits with one thread, with two, and again.
std::vector<Figure> reproducible(FilterMode mode, unsigned seed) {
  Scene scene;
  scene.actors.push_back({"car", 4.4, 1.8, 0.15, 1.5, drives(10.0, -6.0, 1.0, 5.0)});
  scene.actors.push_back({"wall", 20.0, 0.4, 0.0, 2.5, stands(18.0, 8.0)});
  scene.ego = drives(0.0, 0.0, 0.0, 5.0);
  scene.duration_s = 1.0;
  RunOptions run = options(mode, seed);
  const std::uint64_t one = hashOf(drive(scene, run)), again = hashOf(drive(scene, run));
  run.threads = 2;
  const std::uint64_t two = hashOf(drive(scene, run));
  return {atMost("runs that differ: again, with two threads",
                 (one != again ? 1.0 : 0.0) + (one != two ? 1.0 : 0.0), 0.0)};
}

}  // namespace atlas::grid_scene
