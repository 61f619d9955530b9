// SPDX-License-Identifier: MIT
// What the occupancy filter knows of each cell, as it hands it out.
#pragma once

#include <cstdint>
#include <vector>

namespace atlas {

/// Arrays by cell, [row * columns + column]. Velocities are those of the ground in map: the vehicle's own
/// motion is not in them.
struct CellEstimates {
  std::vector<float> occupied;      ///< P(occupied); 0.5 where nothing is known
  std::vector<float> unknown;       ///< share of the belief that rests on no measurement, 0..1
  std::vector<float> static_share;  ///< P(standing | occupied)
  /// Mean and covariance of the velocity given that the cell is occupied by something moving; 0 where there
  /// is no such belief (see `moving`).
  std::vector<float> vx_mps, vy_mps;
  std::vector<float> var_xx, var_xy, var_yy;  ///< m^2/s^2
  std::vector<float> moving;                  ///< P(occupied by something moving)
  /// Share of the moving belief on the outermost velocities: near 1 the true velocity may lie beyond them.
  std::vector<float> saturation;

  void resize(std::size_t cells) {
    for (auto* field : {&occupied, &unknown, &static_share, &vx_mps, &vy_mps, &var_xx, &var_xy, &var_yy,
                        &moving, &saturation})
      field->resize(cells);
  }
};

}  // namespace atlas
