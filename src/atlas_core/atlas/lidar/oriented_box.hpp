// SPDX-License-Identifier: MIT
// The upright box around a cluster. Its yaw is searched so that the points lie near the box's sides: a lidar
// sees two sides of a car, an L (Zhang, Xu, Dong, Dolan 2017, "Efficient L-Shape Fitting for Vehicle
// Detection Using Laser Scanners", algorithms 2 and 4, closeness). The rectangle of least area is no
// substitute: for a perfect L the one along the diagonal has the same area.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/base/outcome.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

/// The box that holds all points of `members` (every one counts), length >= width, yaw in (-pi/2, pi/2].
/// The yaw is that of the outline towards `seen_from_map`: what lies behind it, seen through windows or over
/// a bonnet, says nothing about the sides. kEmpty without members.
[[nodiscard]] Outcome<Obstacle> fitBox(const std::vector<LidarPoint>& points_map,
                                       const std::vector<std::uint32_t>& members,
                                       const Eigen::Vector3d& seen_from_map);

}  // namespace atlas
