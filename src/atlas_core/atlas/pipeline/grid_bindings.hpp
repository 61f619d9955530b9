// SPDX-License-Identifier: MIT
// Inputs and outputs of the second paper's system: stereo camera and occupancy filter.
#pragma once

#include <memory>

#include "atlas/grid/occupancy_products.hpp"
#include "atlas/grid/occupancy_stage.hpp"
#include "atlas/pipeline/common_bindings.hpp"

namespace atlas {

template <class Bus>
StageFactory bindOccupancy(Bus& bus, const OccupancyParams& params) {
  using S = OccupancyStage;
  validate(params);
  rigAndOdometry<S>(bus);
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  inputs<S, SensorGridPtr>(bus, S::kFirstLidar + params.lidars.size(), params.stereo, "/ground");
  const auto grid = bus.template output<OccupancyMapPtr>("grid");
  const auto velocity = bus.template output<GridVelocities>("grid/velocity");
  const auto objects = bus.template output<ObjectsPtr>("grid/objects");
  const auto risk = bus.template output<RiskAnswer>("grid/risk");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_frame = [=](const OccupancyFramePtr& frame) {
      grid(occupancyMap(*frame, params.unknown_above));
      velocity({frame});
      objects(ObjectsPtr(frame, &frame->objects));
      risk({frame->stamp, frame->risk});
    };
    return stage;
  };
}

}  // namespace atlas
