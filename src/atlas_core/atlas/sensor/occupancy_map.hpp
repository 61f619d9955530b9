// SPDX-License-Identifier: MIT
// An occupancy grid in the form of a nav_msgs/OccupancyGrid, so that what is written offline and what is
// written from the topic are the same bytes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "atlas/base/time.hpp"

namespace atlas {

/// Row by row, x along a row, y from row to row; frame map.
struct OccupancyMap {
  Stamp stamp = 0;
  float resolution_m = 0;                            ///< side of a cell; single precision, as in the message
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m: lower corner of the first cell; z of the road
  std::uint32_t columns = 0, rows = 0;               ///< both 0: the vehicle's pose was not known
  std::vector<std::int8_t> percent;                  ///< P(occupied), 0..100; -1 = unknown
};
using OccupancyMapPtr = std::shared_ptr<const OccupancyMap>;

}  // namespace atlas
