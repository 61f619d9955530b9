// SPDX-License-Identifier: MIT
// What one sensor says of the ground around it at one time, as a grid of its own: the stereo camera's view
// from above is one. The occupancy filter lays it into the map.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "atlas/base/geometry.hpp"
#include "atlas/base/time.hpp"

namespace atlas {

/// Cells on the ground, row by row: x grows along a row, y from row to row (as OccupancyGrid).
struct SensorGrid {
  Stamp stamp = 0;
  std::string frame;                      ///< of the sensor
  Pose T_sensor_grid;                     ///< the grid's axes (x, y on the ground, z up) in the sensor frame
  double origin_x_m = 0, origin_y_m = 0;  ///< lower corner of the first cell, grid axes
  double cell_m = 0.2;
  int columns = 0, rows = 0;  ///< along x, along y
  std::vector<float>
      occupied;  ///< P(occupied | this measurement), [row * columns + column]; 0.5 = nothing known
};
using SensorGridPtr = std::shared_ptr<const SensorGrid>;

}  // namespace atlas
