// SPDX-License-Identifier: MIT
// How likely the vehicle hits something, and when, if it goes on as it does: constant speed and yaw rate.
#pragma once

#include <optional>
#include <vector>

#include "atlas/grid/cell_estimates.hpp"
#include "atlas/grid/grid_geometry.hpp"
#include "atlas/sensor/object.hpp"

namespace atlas {

struct RiskParams {
  double horizon_s = 3.0;
  double bin_s = 0.1;
  /// The vehicle's outline around base_link, m.
  double front_m = 3.0, rear_m = 1.5, half_width_m = 0.95;
  double acceleration_mps2 = 1.5;     ///< standard deviation of what objects do against constant velocity
  double min_cell_probability = 0.3;  ///< cells less likely occupied are no obstacle
};
void validate(const RiskParams& params);

/// The vehicle's motion in the plane.
struct EgoMotion {
  Eigen::Vector2d position_map = Eigen::Vector2d::Zero();
  double yaw_rad = 0;
  double speed_mps = 0;  ///< along x of the vehicle
  double yaw_rate_radps = 0;
};

struct CollisionRisk {
  Stamp stamp = 0;
  double bin_s = 0;
  /// P(the first contact falls into [i, i + 1) * bin_s); the rest of 1 is: none up to the horizon.
  std::vector<double> first_contact;
  double total = 0;                       ///< P(contact up to the horizon)
  std::optional<double> expected_time_s;  ///< mean time to contact given that there is one; none: total < 1 %
  double unknown_share = 0;  ///< of the cells on the way, those that nothing is known of or beyond the grid
  std::optional<std::uint32_t> object;  ///< the one most likely hit; none when it is no object
};

/// What moves by its box and covariance, what stands by the probability of its cells: a box would fill what
/// lies between its walls. `cluster_of_cell`: 0 = of none, else cells of the same number are one thing.
[[nodiscard]] CollisionRisk collisionRisk(const EgoMotion& ego, const Objects& objects,
                                          const GridGeometry& geometry, const CellEstimates& cells,
                                          const std::vector<std::int32_t>& cluster_of_cell,
                                          const RiskParams& params);

}  // namespace atlas
