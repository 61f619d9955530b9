// SPDX-License-Identifier: MIT
// Cells filled in by hand: what the tracker looks at, without sensors and filter.
#pragma once

#include <limits>
#include <vector>

#include "atlas/grid/cell_estimates.hpp"
#include "atlas/grid/grid_geometry.hpp"

namespace atlas {

/// 100 x 100 cells of 0.2 m from (0, 0) on, all seen free.
struct GridByHand {
  GridByHand() {
    geometry.columns = geometry.rows = 100;
    cells.resize(geometry.cells());
    evidence.assign(geometry.cells(), 0.2F);
    top_m.assign(geometry.cells(), std::numeric_limits<float>::quiet_NaN());
  }
  /// A seen thing in columns [column, column + width), rows [row, row + height).
  void put(int column, int row, int width, int height, const Eigen::Vector2d& velocity_mps,
           float variance = 0.05F) {
    for (int y = row; y < row + height; ++y) {
      for (int x = column; x < column + width; ++x) {
        if (!geometry.contains(x, y)) continue;
        const std::size_t i = geometry.indexOf(x, y);
        const bool stands = velocity_mps.norm() < 0.1 && variance < 1.0F;
        cells.occupied[i] = 0.95F;
        cells.static_share[i] = stands ? 0.95F : 0.02F;
        cells.moving[i] = stands ? 0.05F : 0.93F;
        cells.vx_mps[i] = static_cast<float>(velocity_mps.x());
        cells.vy_mps[i] = static_cast<float>(velocity_mps.y());
        cells.var_xx[i] = cells.var_yy[i] = variance;
        evidence[i] = 0.9F;
        top_m[i] = 1.4F;
      }
    }
  }
  GridGeometry geometry;
  CellEstimates cells;
  std::vector<float> evidence, top_m;
};

}  // namespace atlas
