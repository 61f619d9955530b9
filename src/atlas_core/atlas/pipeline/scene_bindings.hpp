// SPDX-License-Identifier: MIT
// Inputs and outputs of the stages that make one picture of the scene out of all sensors.
#pragma once

#include <memory>

#include "atlas/fusion/local_map.hpp"
#include "atlas/fusion/object_stage.hpp"
#include "atlas/pipeline/common_bindings.hpp"

namespace atlas {

template <class Bus>
StageFactory bindObjects(Bus& bus, const ObjectParams& params) {
  using S = ObjectStage;
  validate(params);
  const std::size_t obstacles = S::kFirstLidar + params.lidars.size();
  rigAndOdometry<S>(bus);
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  bus.template input<S, Obstacles>(obstacles, "obstacles", [](S& s, const Obstacles& o) { s.push(o); });
  if (params.use_frustums)
    bus.template input<S, Frustums>(obstacles + 1, "frustums", [](S& s, const Frustums& f) { s.push(f); });
  inputs<S, RadarScan>(bus, obstacles + (params.use_frustums ? 2 : 1), params.radars, "/scan");
  const auto objects = bus.template output<ObjectsPtr>("objects");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_objects = objects;
    return stage;
  };
}

template <class Bus>
StageFactory bindLocalMap(Bus& bus, const LocalMapParams& params) {
  using S = LocalMapStage;
  validate(params);
  bus.template input<S, Odometry>(S::kOdometry, "odometry", [](S& s, const Odometry& o) { s.push(o); });
  bus.template input<S, ObjectsPtr>(S::kObjects, "objects", [](S& s, const ObjectsPtr& o) { s.push(o); });
  bus.template input<S, MapCloudPtr>(S::kCloud, "cloud", [](S& s, const MapCloudPtr& c) { s.push(c); });
  bus.template input<S, Frustums>(S::kFrustums, "frustums", [](S& s, const Frustums& f) { s.push(f); });
  bus.template input<S, OccupancyMapPtr>(S::kGrid, "grid", [](S& s, const OccupancyMapPtr& g) { s.push(g); });
  const auto map = bus.template output<LocalMapView>("local_map");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_map = map;
    return stage;
  };
}

}  // namespace atlas
