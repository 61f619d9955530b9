// SPDX-License-Identifier: MIT
// How the vehicle moved during a sweep, without the corrections of the positioning. Each fix moves the pose
// in `map` at once, and a heading that is corrected by 0.5 deg between two points moves what is 30 m away by
// 26 cm: a step within the sweep that the vehicle never made. REP-105 has two frames for it: the pose in
// `map` may jump, that in `odom` is continuous. Here `odom` is the sum of the odometry's velocities, and a
// sweep is placed by the pose in `map` at its stamp and by `odom` from there on.
#pragma once

#include "atlas/base/trajectory.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

class VehicleMotion {
 public:
  /// Poses farther apart than max_gap are not interpolated.
  explicit VehicleMotion(Duration max_gap = kSecond / 2)
      : max_gap_(max_gap), in_map_(max_gap), in_odom_(max_gap) {}

  /// Appends; a stamp not after the last one throws std::invalid_argument. The motion since the odometry
  /// before is the mean of both velocities and both turn rates over the time between.
  void push(const Odometry& odometry);
  /// For poses without velocities: the motion is the difference of the poses, corrections and all.
  void push(const StampedPose& pose);
  /// Drops what no query at or after `stamp` needs.
  void forgetBefore(Stamp stamp);

  [[nodiscard]] const Trajectory& inMap() const { return in_map_; }

  /// T_map_imu from `first` to `last`: the pose in map at `stamp`, moved on and back along `odom`. Poses at
  /// the stamps of the odometry; none outside what is known, where at() then says so. The reason when there
  /// is no pose at `stamp`.
  [[nodiscard]] Outcome<Trajectory> around(Stamp stamp, Stamp first, Stamp last) const;

 private:
  Duration max_gap_;
  Trajectory in_map_, in_odom_;
  Eigen::Vector3d velocity_imu_mps_ = Eigen::Vector3d::Zero(), rate_imu_radps_ = Eigen::Vector3d::Zero();
};

}  // namespace atlas
