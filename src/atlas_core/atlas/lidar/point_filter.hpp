// SPDX-License-Identifier: MIT
// Which points of a sweep are left out because of what they are, beside the range gate: the vehicle's own
// body, beams that are broken, returns that a sensor reports twice. They become NaN and keep their place.
#pragma once

#include <optional>
#include <vector>

#include "atlas/base/geometry.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// A box in the vehicle's frame, m.
struct VehicleBox {
  Eigen::Vector3d lowest = Eigen::Vector3d::Zero(), highest = Eigen::Vector3d::Zero();
};
/// From x_min, y_min, z_min, x_max, y_max, z_max; nothing from no values. Throws std::invalid_argument naming
/// what is wrong.
std::optional<VehicleBox> vehicleBoxFrom(const std::vector<double>& limits_m);

struct PointFilter {
  std::optional<VehicleBox> vehicle;
  std::vector<int> dead_rings;
  bool drop_duplicates = false;  ///< same place as the return before it of the same ring

  [[nodiscard]] bool doesNothing() const { return !vehicle && dead_rings.empty() && !drop_duplicates; }
};
struct FilteredSweep {
  SweepPtr sweep;  ///< the input itself when nothing had to change
  std::size_t on_vehicle = 0, of_dead_rings = 0, duplicates = 0;  ///< points that became NaN
};

/// Points are judged where they were measured, at one pose each: the vehicle moves with its lidar.
[[nodiscard]] FilteredSweep filterPoints(const SweepPtr& sweep, const PointFilter& filter,
                                         const Pose& T_imu_lidar);

}  // namespace atlas
