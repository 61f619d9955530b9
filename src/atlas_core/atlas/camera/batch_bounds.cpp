// SPDX-License-Identifier: MIT
#include "atlas/camera/batch_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {

bool BatchBounds::add(const Eigen::Vector3f& p_lidar) {
  const float range = p_lidar.norm();
  if (!(range > 0.0F && std::isfinite(range))) return false;
  const Eigen::Vector3f direction = p_lidar / range;
  if (empty()) {
    low_direction = high_direction = direction;
    min_range_m = max_range_m = range;
    return true;
  }
  low_direction = low_direction.cwiseMin(direction);
  high_direction = high_direction.cwiseMax(direction);
  min_range_m = std::min(min_range_m, range);
  max_range_m = std::max(max_range_m, range);
  return true;
}

}  // namespace atlas
