// SPDX-License-Identifier: MIT
// Rigid transforms. A Pose named T_map_imu maps coordinates from imu to map: p_map = T_map_imu * p_imu, and
// neighbours must match in a product: T_map_lidar = T_map_imu * T_imu_lidar.
// Rotation is kept as a quaternion (not a matrix) so that a pose survives a message unchanged, bit by bit.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace atlas {

struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         ///< m

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation * p + translation; }
  Pose operator*(const Pose& other) const {
    return {rotation * other.rotation, rotation * other.translation + translation};
  }
  [[nodiscard]] Pose inverse() const {
    const Eigen::Quaterniond r = rotation.conjugate();
    return {r, -(r * translation)};
  }
  /// 3x4 float matrix [R | t], for loops over points.
  [[nodiscard]] Eigen::Matrix<float, 3, 4> matrix34f() const {
    Eigen::Matrix<float, 3, 4> m;
    m.leftCols<3>() = rotation.toRotationMatrix().cast<float>();
    m.col(3) = translation.cast<float>();
    return m;
  }
};

/// Pose at `ratio` between a (0) and b (1): slerp of rotation, linear translation. Ratio outside [0, 1]
/// throws std::invalid_argument: there is no silent extrapolation.
Pose interpolate(const Pose& a, const Pose& b, double ratio);

/// Fixed-axis roll (x), pitch (y), yaw (z), rad: R = Rz(yaw) Ry(pitch) Rx(roll), REP-103.
struct RollPitchYaw {
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
};
RollPitchYaw toRollPitchYaw(const Eigen::Quaterniond& q);
Eigen::Quaterniond fromRollPitchYaw(const RollPitchYaw& rpy);

/// The same angle in (-pi, pi].
double wrapAngle(double angle_rad);

/// Rotation vector (axis * angle, rad) to quaternion and back (Sola 2017, "Quaternion kinematics", eq. 101
/// and 105).
Eigen::Quaterniond expSo3(const Eigen::Vector3d& rotation_vector_rad);
Eigen::Vector3d logSo3(const Eigen::Quaterniond& q);

/// [v]_x, the matrix with skew(v) * u = v x u.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

}  // namespace atlas
