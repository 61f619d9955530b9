// SPDX-License-Identifier: MIT
// Clusters of what stands on the ground. Points are gathered in upright columns and each column is cut into
// pieces where its heights leave a gap; pieces belong together when a chain of them has no gap wider than the
// tolerance, which grows with the distance from the vehicle as the beams of a lidar spread. Gaps upwards have
// a tolerance of their own: the rings of a lidar are much wider apart than the points of a ring, and a crown
// above a car must not join it. Idea of the columns: Himmelsbach et al. 2010, "Fast segmentation of 3D point
// clouds for ground vehicles"; tolerance by range: Klasing et al. 2008, "A clustering method for efficient
// segmentation of 3D laser data".
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct ClusterParams {
  double column_m = 0.2;          ///< edge of a column
  double tolerance_m = 0.3;       ///< horizontal gap that is bridged at the vehicle
  double tolerance_per_m = 0.02;  ///< added for each metre of range
  double step_m = 0.35;           ///< gap in height that is bridged at the vehicle
  double step_per_m = 0.02;       ///< added for each metre of range
  double tall_m = 2.1;            ///< pieces taller than this are walls, trees, poles, buses
  double object_m = 6.0;          ///< diagonal from above of low clusters that stay apart from tall ones
  int fewest_points = 8;          ///< of such a cluster
};

/// Point indices of each cluster, ascending; clusters ordered by their smallest index. Which points belong
/// together does not depend on their order. Points that are not finite are in none. Range is counted from
/// `vehicle_map`. std::invalid_argument when column_m, tolerance_m or step_m is not positive or a growth is
/// negative.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> findClusters(const std::vector<LidarPoint>& points_map,
                                                                   const Eigen::Vector3d& vehicle_map,
                                                                   const ClusterParams& params);

}  // namespace atlas
