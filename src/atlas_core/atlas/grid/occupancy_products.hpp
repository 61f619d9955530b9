// SPDX-License-Identifier: MIT
// The occupancy filter's answer as it leaves the stage: one frame as the values of its four topics.
#pragma once

#include <optional>

#include "atlas/grid/occupancy_chain.hpp"
#include "atlas/sensor/occupancy_map.hpp"

namespace atlas {

/// Topic grid. A cell whose belief rests on no measurement by more than `unknown_above` is unknown.
[[nodiscard]] OccupancyMapPtr occupancyMap(const OccupancyFrame& frame, double unknown_above);

/// Topic grid/velocity.
struct GridVelocities {
  OccupancyFramePtr frame;
};
/// Topic grid/risk.
struct RiskAnswer {
  Stamp stamp = 0;
  std::optional<CollisionRisk> risk;  ///< none: the vehicle's motion or place is not known
};

}  // namespace atlas
