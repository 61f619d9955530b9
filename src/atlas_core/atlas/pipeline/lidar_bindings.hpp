// SPDX-License-Identifier: MIT
// Inputs and outputs of the stages of the lidars.
#pragma once

#include <memory>

#include "atlas/lidar/aggregate_stage.hpp"
#include "atlas/lidar/deskew_stage.hpp"
#include "atlas/lidar/line_stage.hpp"
#include "atlas/lidar/obstacle_stage.hpp"
#include "atlas/pipeline/common_bindings.hpp"

namespace atlas {

template <class Bus>
StageFactory bindDeskew(Bus& bus, const DeskewParams& params) {
  using S = DeskewStage;
  validate(params);
  rigAndOdometry<S>(bus);
  inputs<S, SweepPtr>(bus, S::kFirstLidar, params.lidars, "/points");
  const auto batches = outputs<BatchedSweepPtr>(bus, params.lidars, "/batches");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_batches = batches;
    return stage;
  };
}

template <class Bus>
StageFactory bindAggregate(Bus& bus, const AggregateParams& params) {
  using S = AggregateStage;
  validate(params);
  inputs<S, BatchedSweepPtr>(bus, 0, params.lidars, "/batches");
  const auto cloud = bus.template output<MapCloudPtr>("cloud");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_cloud = cloud;
    return stage;
  };
}

template <class Bus>
StageFactory bindObstacles(Bus& bus, const ObstacleParams& params) {
  using S = ObstacleStage;
  validate(params);
  bus.template input<S, Odometry>(S::kOdometry, "odometry", [](S& s, const Odometry& o) { s.push(o); });
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  const auto obstacles = bus.template output<Obstacles>("obstacles");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_obstacles = obstacles;
    return stage;
  };
}

template <class Bus>
StageFactory bindLines(Bus& bus, const LineParams& params) {
  validate(params);
  inputs<LineStage, BatchedSweepPtr>(bus, 0, params.lidars, "/batches");
  return [params, lines = outputs<Lines>(bus, params.lidars, "/lines")] {
    auto stage = std::make_unique<LineStage>(params);
    stage->on_lines = lines;
    return stage;
  };
}

}  // namespace atlas
