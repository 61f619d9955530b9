// SPDX-License-Identifier: MIT
// The orientation model of the paper (section IV-A): the IMU's angular velocity for a fast response, a
// low-pass towards a measured direction of "up" (the IMU's own roll and pitch, or gravity when standing)
// against the drift. The IMU's own yaw is magnetic and never used: only directions of "up" enter here, and
// they carry no yaw.
//
// The low-pass is the passive complementary filter of Mahony, Hamel, Pflimlin 2008 (eq. 47-48) with k_P =
// 1/tau and the integral gain k_I = k_P^2/16, which takes out the gyroscopes' bias about the level axes
// (damping ratio 2).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace atlas {

struct AttitudeParams {
  double tilt_time_constant_s = 2.5;
  double tilt_sigma_rad = 0.0044;
  double gyroscope_noise_radps_sqrt_hz = 0.0005;
  double gyroscope_bias_radps = 0.0035;
};

class AttitudeModel {
 public:
  explicit AttitudeModel(const AttitudeParams& params) : params_(params) {}

  /// Roll and pitch from the direction of "up" in the imu frame; yaw is 0 until setYaw().
  void initialize(const Eigen::Vector3d& up_imu);
  [[nodiscard]] bool known() const { return known_; }

  /// Integrates angular velocity (bias not yet removed) that changes linearly from `first` to `second` over
  /// dt.
  void integrate(const Eigen::Vector3d& first_radps, const Eigen::Vector3d& second_radps, double dt_s);
  /// Pulls roll and pitch towards a measured "up" (unit, imu frame) valid for the past dt; up_map: the same
  /// in map.
  void correctTilt(const Eigen::Vector3d& up_imu, const Eigen::Vector3d& up_map, double dt_s);
  /// Turns the model about map's z axis.
  void turn(double angle_rad);
  void setYaw(double yaw_rad) { turn(yaw_rad - yaw()); }
  /// The z component belongs to the heading filter, x and y are estimated here.
  void setBiasZ(double bias_radps) { bias_radps_.z() = bias_radps; }

  [[nodiscard]] const Eigen::Quaterniond& R_map_imu() const { return R_map_imu_; }
  [[nodiscard]] double yaw() const;
  [[nodiscard]] const Eigen::Vector3d& bias_radps() const { return bias_radps_; }
  /// Of the rotation about each level axis, rad^2.
  [[nodiscard]] double tiltVariance() const { return tilt_variance_; }

 private:
  AttitudeParams params_;
  bool known_ = false;
  Eigen::Quaterniond R_map_imu_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d bias_radps_ = Eigen::Vector3d::Zero();
  double tilt_variance_ = 0.0;
  double uncorrected_s_ = 0.0;  ///< time since the last correctTilt
};

}  // namespace atlas
