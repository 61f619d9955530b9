// SPDX-License-Identifier: MIT
#include "atlas/localization/eskf_measurement.hpp"

#include <cmath>

namespace atlas::eskf {

Measurement<3> fixMeasurement(const State& state, const Eigen::Vector3d& rate_radps,
                              const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2) {
  const Eigen::Matrix3d R = state.R.toRotationMatrix();
  const Eigen::Vector3d sweep = rate_radps.cross(state.lever);
  const Eigen::Vector3d arm = R * (state.lever - state.delay_s * sweep);
  Measurement<3> z;
  z.y = p_map_antenna - (state.p + arm - state.delay_s * state.v);
  z.H.block<3, 3>(0, kP).setIdentity();
  z.H.block<3, 3>(0, kV) = -state.delay_s * Eigen::Matrix3d::Identity();
  z.H.block<3, 3>(0, kTheta) = -skew(arm);
  z.H.block<3, 3>(0, kGyro) = -state.delay_s * R * skew(state.lever);
  z.H.block<3, 3>(0, kLever) = R * (Eigen::Matrix3d::Identity() - state.delay_s * skew(rate_radps));
  z.H.block<3, 1>(0, kDelay) = -(state.v + R * sweep);
  z.R = R_m2;
  return z;
}

Measurement<1> headingMeasurement(const State& state, double yaw_rad, double variance) {
  const Eigen::Vector3d x = state.R * Eigen::Vector3d::UnitX();
  const double level_sq = x.head<2>().squaredNorm();
  Measurement<1> z;
  z.y(0) = wrapAngle(yaw_rad - std::atan2(x.y(), x.x()) - state.heading_slow_rad);
  z.H.block<1, 3>(0, kTheta) << -x.z() * x.x() / level_sq, -x.z() * x.y() / level_sq, 1.0;
  z.H(0, kHeadingSlow) = 1.0;
  z.R(0, 0) = variance;
  return z;
}

Measurement<1> heightMeasurement(const State& state, double z_map_m, double variance) {
  Measurement<1> z;
  z.y(0) = z_map_m - state.p.z();
  z.H(0, kP + 2) = 1.0;
  z.R(0, 0) = variance;
  return z;
}

Measurement<2> upMeasurement(const State& state, const Eigen::Vector3d& up_imu, const Eigen::Vector3d& up_map,
                             double variance) {
  const Eigen::Vector3d seen = state.R * up_imu;  // = up - theta x up, first order
  Measurement<2> z;
  z.y = (up_map - seen).head<2>();
  z.H.block<2, 3>(0, kTheta) = -skew(seen).topRows<2>();
  z.R = variance * Eigen::Matrix2d::Identity();
  return z;
}

Measurement<2> wheelsMeasurement(const State& state, const Eigen::Vector3d& rate_radps, double slip_variance,
                                 double hop_variance) {
  const Eigen::Matrix3d R_vehicle_imu =
      Eigen::AngleAxisd(-state.mounted_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d R_vehicle_map = R_vehicle_imu * state.R.conjugate();
  const Eigen::Vector3d u = R_vehicle_map * state.v, w = R_vehicle_imu * rate_radps;
  Eigen::Matrix<double, 2, 3> select;  // of u
  select << -state.mount_yaw, 1.0, 0.0, state.mount_pitch, 0.0, 1.0;
  Measurement<2> z;
  z.y = -(select * u + state.axle_m * Eigen::Vector2d(-w.z(), w.y()));
  z.H.block<2, 3>(0, kV) = select * R_vehicle_map;
  z.H.block<2, 3>(0, kTheta) = select * R_vehicle_map * skew(state.v);
  z.H(0, kGyro + 2) = state.axle_m;
  z.H.block<1, 3>(1, kGyro) = -state.axle_m * R_vehicle_imu.row(1);
  z.H(0, kMountYaw) = -u.x();
  z.H(1, kMountPitch) = u.x();
  z.H(0, kAxle) = -w.z();
  z.H(1, kAxle) = w.y();
  z.R = Eigen::Vector2d(slip_variance, hop_variance).asDiagonal();
  return z;
}

Measurement<3> standingMeasurement(const State& state, double variance) {
  Measurement<3> z;
  z.y = -state.v;
  z.H.block<3, 3>(0, kV).setIdentity();
  z.R = variance * Eigen::Matrix3d::Identity();
  return z;
}

Measurement<3> notTurningMeasurement(const State& state, const Earth& earth,
                                     const Eigen::Vector3d& gyro_radps, double variance) {
  const Eigen::Matrix3d R_imu_map = state.R.conjugate().toRotationMatrix();
  Measurement<3> z;
  z.y = gyro_radps - state.gyro_bias - R_imu_map * earth.rotation_radps;
  z.H.block<3, 3>(0, kGyro).setIdentity();
  z.H.block<3, 3>(0, kTheta) = R_imu_map * skew(earth.rotation_radps);
  z.R = variance * Eigen::Matrix3d::Identity();
  return z;
}

}  // namespace atlas::eskf
