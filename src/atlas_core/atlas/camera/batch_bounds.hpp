// SPDX-License-Identifier: MIT
// Where the points of a batch lie, seen from the lidar: a box of directions and an interval of ranges. A
// rotating lidar's batch is a narrow fan, so most batches of a sweep can be told to be outside a camera's
// view without looking at their points.
#pragma once

#include <Eigen/Core>

namespace atlas {

struct BatchBounds {
  Eigen::Vector3f low_direction =
      Eigen::Vector3f::Zero();  ///< smallest x, y, z of the unit vectors to the points
  Eigen::Vector3f high_direction = Eigen::Vector3f::Zero();  ///< largest
  float min_range_m = 0, max_range_m = -1;                   ///< max < min: no finite point

  [[nodiscard]] bool empty() const { return max_range_m < min_range_m; }
  /// A point at the lidar itself has no direction: it is no measurement and not taken. False then, and when
  /// it is not finite.
  bool add(const Eigen::Vector3f& p_lidar);

  /// Largest value of normal . p + offset over all p = range * direction inside the bounds (not empty).
  [[nodiscard]] float largest(const Eigen::Vector3f& normal, float offset) const {
    const float along =
        normal.cwiseProduct(low_direction).cwiseMax(normal.cwiseProduct(high_direction)).sum();
    return offset + along * (along > 0.0F ? max_range_m : min_range_m);
  }
};

}  // namespace atlas
