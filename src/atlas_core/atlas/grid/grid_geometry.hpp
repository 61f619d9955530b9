// SPDX-License-Identifier: MIT
// Where the cells of the occupancy grid lie. Cells are squares of the map frame with corners on multiples of
// their size, whatever the vehicle does: the grid follows it by whole cells and never turns, so a standing
// thing stays in its cell through the sharpest turn.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace atlas {

struct GridParams {
  double length_m = 40.0;  ///< along x of map
  double width_m = 40.0;   ///< along y of map
  double cell_m = 0.2;
  double ahead_m = 15.0;  ///< middle of the grid, before the vehicle; 0: the grid lies around it
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const GridParams& params);

/// Cells row by row: x grows along a row (columns), y from row to row, as in an OccupancyGrid.
struct GridGeometry {
  double cell_m = 0.2;
  int columns = 0, rows = 0;
  std::int64_t first_column = 0, first_row = 0;  ///< of the map's cells: cell i covers [i, i + 1) * cell_m

  [[nodiscard]] std::size_t cells() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  [[nodiscard]] std::size_t indexOf(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }
  /// Corner of the first cell, m, map.
  [[nodiscard]] Eigen::Vector2d corner() const {
    return {static_cast<double>(first_column) * cell_m, static_cast<double>(first_row) * cell_m};
  }
  /// Middle of a cell, m, map.
  [[nodiscard]] Eigen::Vector2d middleOf(int column, int row) const {
    return {(static_cast<double>(first_column + column) + 0.5) * cell_m,
            (static_cast<double>(first_row + row) + 0.5) * cell_m};
  }
  /// Column of x and row of y, m, map; they may lie outside the grid.
  [[nodiscard]] int columnOf(double x) const {
    return static_cast<int>(static_cast<std::int64_t>(std::floor(x / cell_m)) - first_column);
  }
  [[nodiscard]] int rowOf(double y) const {
    return static_cast<int>(static_cast<std::int64_t>(std::floor(y / cell_m)) - first_row);
  }
};

/// The grid for a vehicle at (x, y) of map that looks along yaw.
[[nodiscard]] GridGeometry placeGrid(const GridParams& params, const Eigen::Vector2d& vehicle_map,
                                     double yaw_rad);

}  // namespace atlas
