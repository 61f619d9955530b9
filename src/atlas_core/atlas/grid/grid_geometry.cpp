// SPDX-License-Identifier: MIT
#include "atlas/grid/grid_geometry.hpp"

#include <stdexcept>
#include <string>

namespace atlas {
namespace {

constexpr int kMostCells = 4000;  ///< along one side

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("grid: " + what + ", got " + std::to_string(value));
}

int cellsAlong(double side_m, double cell_m) { return static_cast<int>(std::lround(side_m / cell_m)); }

}  // namespace

void validate(const GridParams& p) {
  need(p.cell_m >= 0.02 && p.cell_m <= 5.0, "cell_m must lie in [0.02, 5]", p.cell_m);
  for (const double side_m : {p.length_m, p.width_m}) {
    need(side_m >= p.cell_m && side_m <= kMostCells * p.cell_m,
         "length_m and width_m must lie in [1, 4000] cells", side_m);
  }
  need(std::abs(p.ahead_m) <= 500.0, "ahead_m must lie in [-500, 500]", p.ahead_m);
}

GridGeometry placeGrid(const GridParams& params, const Eigen::Vector2d& vehicle_map, double yaw_rad) {
  GridGeometry geometry;
  geometry.cell_m = params.cell_m;
  geometry.columns = cellsAlong(params.length_m, params.cell_m);
  geometry.rows = cellsAlong(params.width_m, params.cell_m);
  const Eigen::Vector2d middle =
      vehicle_map + params.ahead_m * Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
  geometry.first_column = std::llround(middle.x() / params.cell_m - 0.5 * geometry.columns);
  geometry.first_row = std::llround(middle.y() / params.cell_m - 0.5 * geometry.rows);
  return geometry;
}

}  // namespace atlas
