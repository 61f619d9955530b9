// SPDX-License-Identifier: MIT
// First attitude, position and velocity, standing or in motion: position and velocity of the antenna from the
// fixes (nearly constant velocity), heading from the receiver's two antennas or from the direction of the
// velocity, roll and pitch from the IMU's own orientation or from gravity. Nothing is guessed: until all are
// known there is no state.
//
// Gravity without an own orientation, the best that there is:
//   standing   the mean force is -g, the mean rate is the gyroscope's bias; both stay valid for the drive
//   that
//              follows, carried along by the gyroscope
//   driving    the force F averaged over a span T is that of a known motion: R F = (v - v0) / T - g
//              (velocity matching; Groves 2013, 5.6.2), solved for roll and pitch with the yaw given
//   neither    the mean direction of the force over some seconds: a car that speeds up looks tilted
// In all three an accelerometer bias b tilts by theta = (-(R b)_y, (R b)_x, 0) / g: they are correlated.
#pragma once

#include <array>
#include <optional>

#include "atlas/localization/eskf_motion.hpp"
#include "atlas/localization/eskf_mount.hpp"
#include "atlas/localization/imu_monitor.hpp"
#include "atlas/localization/kalman_1d_axis.hpp"
#include "atlas/localization/positioning_filter.hpp"

namespace atlas::eskf {

class Start {
 public:
  Start(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu, const Earth& earth);

  /// Time passes from one inertial measurement to the next; stamp: of the second.
  void move(Stamp stamp, const Inertial& first, const Inertial& second, double dt_s);
  /// The IMU's own orientation: only its direction of "up" is used.
  void orientation(const Eigen::Quaterniond& R_enu_imu);
  void fix(const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2);
  void heading(double yaw_rad, double variance);
  /// Yaw of the imu as the fixes and the accelerometers together have it; none until enough was seen, or when
  /// the course is not known.
  [[nodiscard]] std::optional<double> seenYaw() const;
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
  /// Direction of "up" in the imu frame, and the variance of the tilt that is not the accelerometer's bias.
  struct Up {
    Eigen::Vector3d direction_imu;
    double variance;
  };
  [[nodiscard]] std::optional<Yaw> course() const;
  [[nodiscard]] double mounted() const;  ///< 0 when the imu looks forward, as it should
  [[nodiscard]] Up up(double yaw_rad) const;
  [[nodiscard]] double velocityVariance() const;  ///< of the worse horizontal axis
  [[nodiscard]] Eigen::Vector3d velocity() const;
  void watchStanding(const ImuMonitor::Block& block);
  void matchVelocity();

  PositioningParams params_;
  Eigen::Vector3d lever_;
  Earth earth_;
  std::array<Kalman1dAxis, 3> axes_;
  bool located_ = false;
  bool own_up_ = false;
  double elapsed_s_ = 0.0;
  Eigen::Vector3d up_imu_ = Eigen::Vector3d::Zero();
  double heading_age_s_ = 0.0;

  MountYaw mount_;
  ImuMonitor monitor_;
  std::optional<ImuMonitor::Block> block_before_;
  int still_blocks_ = 0;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  double still_s_ = 0.0;    ///< the bias is a mean over so long; 0: the vehicle has not stood
  double unstill_s_ = 0.0;  ///< since it stood
  Eigen::Vector3d impulse_imu_ = Eigen::Vector3d::Zero();  ///< of the force since v0 was known
  Eigen::Vector3d v0_ = Eigen::Vector3d::Zero();
  double v0_variance_ = 0.0, matched_s_ = 0.0;
  bool matching_ = false;
  std::optional<Yaw> heading_;  ///< carried along by the gyroscope
};

}  // namespace atlas::eskf
