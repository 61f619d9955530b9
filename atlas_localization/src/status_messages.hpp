// SPDX-License-Identifier: MIT
// Messages of what the localization says beside the odometry: status, bias of the IMU, fused fix, path.
#pragma once

#include <atlas_msgs/ImuBias.h>
#include <atlas_msgs/LocalizationStatus.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/NavSatFix.h>

#include <vector>

#include "atlas/localization/localization_status.hpp"
#include "atlas_ros/conversions.hpp"

namespace atlas_localization {

atlas_msgs::LocalizationStatus toMsg(const atlas::LocalizationStatus& status);
atlas_msgs::ImuBias toMsg(const atlas::ImuBias& bias, atlas::Stamp stamp);
/// WGS84 position of base_link with its covariance in east, north, up of map (parallel to those of the place
/// within 1e-5 rad a hundred metres).
sensor_msgs::NavSatFix fusedFix(const atlas::Odometry& odometry, const atlas::LocalEnu& map);
/// map -> odom (identity: the filter is global) -> base_link.
std::vector<geometry_msgs::TransformStamped> transformsOf(const atlas::Odometry& odometry);

/// The way travelled: a pose every 0.5 m, at most 20000 (then every second one goes: constant memory). It is
/// due to be published when it has grown by a hundredth, so that its cost per pose stays constant.
class GrowingPath {
 public:
  /// True when it should be published now.
  bool extend(const atlas::Odometry& odometry);
  [[nodiscard]] const nav_msgs::Path& message() const { return path_; }
  /// True when poses have come since it was last due.
  [[nodiscard]] bool hasMore() const { return waiting_ > 0; }

 private:
  nav_msgs::Path path_;
  std::size_t waiting_ = 0;
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();
};

}  // namespace atlas_localization
