// SPDX-License-Identifier: MIT
// First attitude, position and velocity, standing or in motion: roll and pitch from the IMU's own orientation
// or from the mean direction of gravity (carried along by the gyroscope), position and velocity of the
// antenna from the fixes (nearly constant velocity), heading from the receiver's two antennas or from the
// direction of the velocity. Nothing is guessed: until all are known there is no state.
#pragma once

#include <array>
#include <optional>

#include "atlas/localization/eskf_motion.hpp"
#include "atlas/localization/kalman_1d_axis.hpp"
#include "atlas/localization/positioning_filter.hpp"

namespace atlas::eskf {

class Start {
 public:
  Start(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu, const Earth& earth);

  /// Time passes from one inertial measurement to the next.
  void move(const Inertial& first, const Inertial& second, double dt_s);
  /// The IMU's own orientation: only its direction of "up" is used.
  void orientation(const Eigen::Quaterniond& R_enu_imu);
  void fix(const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2);
  void heading(double yaw_rad, double variance);
  [[nodiscard]] bool upKnown() const { return own_up_ || elapsed_s_ > kUpAfter_s; }

  struct Result {
    State state;
    Matrix P = Matrix::Zero();
    bool from_velocity = false;  ///< the heading is that of the velocity
  };
  /// The state at the present measurement, once all of it is known.
  [[nodiscard]] std::optional<Result> result(const Inertial& now) const;

 private:
  static constexpr double kUpAfter_s = 1.0;
  struct Yaw {
    double yaw_rad, variance;
  };
  [[nodiscard]] std::optional<Yaw> course() const;

  PositioningParams params_;
  Eigen::Vector3d lever_;
  Earth earth_;
  std::array<Kalman1dAxis, 3> axes_;
  bool located_ = false;
  bool own_up_ = false;
  double elapsed_s_ = 0.0;
  Eigen::Vector3d up_imu_ = Eigen::Vector3d::Zero();
  double heading_age_s_ = 0.0;
  std::optional<Yaw> heading_;  ///< carried along by the gyroscope
};

}  // namespace atlas::eskf
