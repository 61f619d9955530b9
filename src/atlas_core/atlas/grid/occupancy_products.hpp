// SPDX-License-Identifier: MIT
// The occupancy filter's answer as it leaves the stage: the grid in the form of a nav_msgs/OccupancyGrid, so
// that what is written offline and what is written from the topic are the same bytes, and wrappers that tell
// the topics of one frame apart.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "atlas/grid/occupancy_chain.hpp"

namespace atlas {

/// Row by row, x along a row, y from row to row; frame map.
struct OccupancyMap {
  Stamp stamp = 0;
  float resolution_m = 0;                            ///< side of a cell; single precision, as in the message
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< lower corner of the first cell; z of the road
  std::uint32_t columns = 0, rows = 0;               ///< both 0: the vehicle's pose was not known
  std::vector<std::int8_t> percent;                  ///< P(occupied), 0..100; -1 = unknown
};
using OccupancyMapPtr = std::shared_ptr<const OccupancyMap>;

/// A cell whose belief rests on no measurement by more than `unknown_above` is unknown.
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
