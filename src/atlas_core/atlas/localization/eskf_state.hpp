// SPDX-License-Identifier: MIT
// State of the error-state Kalman filter (Sola 2017, "Quaternion kinematics for the error-state Kalman
// filter", chapter 7; Groves 2013, "Principles of GNSS, Inertial, and Multisensor Integrated Navigation",
// chapter 14).
//
//   nominal state   p, v in map (ENU at the anchor); R = R_map_imu; biases in the imu frame; the slow error
//   of
//                   the GNSS heading; where the vehicle is on its wheels: direction of driving in the imu
//                   frame (a constant angle about z, then mount yaw and pitch, tangents from there) and
//                   distance of the rear axle behind the imu; lever arm of the antenna; delay of the fixes
//   error state     true = nominal (+) error, additive but for the attitude: R_true = exp([theta]x) R, the
//                   rotation error theta about the axes of map (the "global" error of Sola, 7.1)
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "atlas/base/geometry.hpp"
#include "atlas/base/time.hpp"

namespace atlas::eskf {

/// Where each error begins in the error vector.
enum Index {
  kP = 0,             ///< position, m
  kV = 3,             ///< velocity, m/s
  kTheta = 6,         ///< rotation about map's axes, rad
  kGyro = 9,          ///< gyroscope bias, rad/s
  kAccel = 12,        ///< accelerometer bias, m/s^2
  kHeadingSlow = 15,  ///< slow error of the GNSS heading, rad
  kMountYaw = 16,     ///< tangent of the angle from imu x (turned by mounted_rad) to the direction of driving
  kMountPitch = 17,   ///< same, about the level axis across
  kAxle = 18,         ///< the rear axle is so far behind the imu, m
  kLever = 19,        ///< antenna in the imu frame, m
  kDelay = 22,        ///< a fix stamped t belongs to t - delay, s
  kSize = 23
};
constexpr int kMoving = 9;  ///< errors of p, v, theta: the only ones with coupled dynamics; they come first

using Vector = Eigen::Matrix<double, kSize, 1>;
using Matrix = Eigen::Matrix<double, kSize, kSize>;

struct State {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  double heading_slow_rad = 0.0;
  double mounted_rad =
      0.0;  ///< about imu z, not estimated: 0 unless the imu is mounted across (eskf_mount.hpp)
  double mount_yaw = 0.0, mount_pitch = 0.0;
  double axle_m = 0.0;
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();
  double delay_s = 0.0;
};

/// state (+) error.
inline void inject(State& state, const Vector& error) {
  state.p += error.segment<3>(kP);
  state.v += error.segment<3>(kV);
  state.R = (expSo3(error.segment<3>(kTheta)) * state.R).normalized();
  state.gyro_bias += error.segment<3>(kGyro);
  state.accel_bias += error.segment<3>(kAccel);
  state.heading_slow_rad += error(kHeadingSlow);
  state.mount_yaw += error(kMountYaw);
  state.mount_pitch += error(kMountPitch);
  state.axle_m += error(kAxle);
  state.lever += error.segment<3>(kLever);
  state.delay_s += error(kDelay);
}

}  // namespace atlas::eskf
