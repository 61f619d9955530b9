// SPDX-License-Identifier: MIT
// With the odometry at stamps k - 1 and k, dt apart (trapezoid; what is left out grows with dt^3):
//   R = exp(dt (w_{k-1} + w_k) / 2),  t = dt (v_{k-1} + R v_k) / 2,  T_odom_imu(k) = T_odom_imu(k-1) [R t]
#include "atlas/lidar/vehicle_motion.hpp"

#include <algorithm>

namespace atlas {

void VehicleMotion::push(const Odometry& odometry) {
  Pose T_odom_imu = odometry.T_map_imu;  // the two begin together
  if (!in_odom_.empty()) {
    const StampedPose& before = in_odom_.poses().back();
    const double dt_s = toSeconds(odometry.stamp - before.stamp);
    Pose step;
    step.rotation = expSo3(0.5 * dt_s * (rate_imu_radps_ + odometry.angular_velocity_imu_radps));
    step.translation = 0.5 * dt_s * (velocity_imu_mps_ + step.rotation * odometry.velocity_imu_mps);
    T_odom_imu = before.pose * step;
    T_odom_imu.rotation.normalize();
  }
  in_map_.push({odometry.stamp, odometry.T_map_imu});
  in_odom_.push({odometry.stamp, T_odom_imu});
  velocity_imu_mps_ = odometry.velocity_imu_mps;
  rate_imu_radps_ = odometry.angular_velocity_imu_radps;
}

void VehicleMotion::push(const StampedPose& pose) {
  in_map_.push(pose);
  in_odom_.push(pose);
}

void VehicleMotion::forgetBefore(Stamp stamp) {
  in_map_.forgetBefore(stamp);
  in_odom_.forgetBefore(stamp);
}

Outcome<Trajectory> VehicleMotion::around(Stamp stamp, Stamp first, Stamp last) const {
  const Outcome<Pose> T_map_imu = in_map_.at(stamp), T_odom_imu = in_odom_.at(stamp);
  if (!T_map_imu) return T_map_imu.reason();
  const Pose T_map_odom = *T_map_imu * T_odom_imu->inverse();
  Trajectory result(max_gap_);
  const auto& poses = in_odom_.poses();
  auto next = std::upper_bound(poses.begin(), poses.end(), first,
                               [](Stamp s, const StampedPose& p) { return s < p.stamp; });
  if (next != poses.begin()) --next;
  for (; next != poses.end(); ++next) {
    result.push({next->stamp, T_map_odom * next->pose});
    if (next->stamp >= last) break;
  }
  return result;
}

}  // namespace atlas
