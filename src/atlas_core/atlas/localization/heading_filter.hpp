// SPDX-License-Identifier: MIT
// Heading from three sources (paper, section IV-A): the gyroscope carries it, the GNSS receiver's two
// antennas and the direction of the velocity correct it. No blend of fixed weights: an error-state Kalman
// filter weighs them by their variances, so the faster the vehicle moves, the more its velocity's direction
// counts, and with neither source the gyroscope holds the heading while its variance grows.
//
//   errors      [yaw, gyroscope bias about z, distance imu to rear axle, slow error of the GNSS heading]
//   dynamics    yaw' = -(bias error) + n_g;  bias' = n_w;  distance' = 0;  slow error: first-order
//   Gauss-Markov GNSS        z = yaw + slow error + white     (the receiver's noise of about 3 deg is
//   correlated over many samples;
//                                                 taken as white it would be believed far too much)
//   velocity    z = yaw + distance * yaw rate / speed + slip     (the rear axle cannot move sideways; a point
//   ahead of
//                                                 it by `distance` moves at that angle: the bicycle model,
//                                                 Rajamani 2012, 2.2)
//
// The yaw itself lives in the attitude model: corrections are returned, to be applied there.
#pragma once

#include <Eigen/Core>

#include "atlas/base/outcome.hpp"

namespace atlas {

struct HeadingParams {
  double gnss_slow_share = 0.8;
  double gnss_slow_time_s = 20.0;
  double gyroscope_noise_radps_sqrt_hz = 0.0005;
  double gyroscope_bias_radps = 0.0035;
  double gyroscope_bias_walk_radps2_sqrt_hz = 1e-5;
  double imu_to_rear_axle_m = 1.3;
  double imu_to_rear_axle_sigma_m = 0.7;
  double slip_rad = 0.01;
  double gate_mahalanobis_sq = 16.0;
};

/// Direction of motion of the imu over ground.
struct VelocityHeading {
  double course_rad = 0.0;       ///< atan2(v_north, v_east)
  double course_variance = 0.0;  ///< of the velocity's direction, rad^2
  double speed_mps = 0.0;        ///< > 0
  double yaw_rate_radps = 0.0;   ///< bias removed
};

class HeadingFilter {
 public:
  explicit HeadingFilter(const HeadingParams& params);

  /// The yaw was just set to a GNSS heading of this variance.
  void initializeFromGnss(double variance);
  /// The yaw was just set to yawOf() a velocity; forward motion is assumed. gnss_variance: of GNSS headings
  /// to come.
  void initializeFromVelocity(const VelocityHeading& velocity, double gnss_variance);
  [[nodiscard]] bool known() const { return known_; }
  void forget();

  void predict(double dt_s);
  /// Both return the angle to add to the yaw, or kLowQuality for an outlier.
  Outcome<double> correctByGnss(double yaw_rad, double measured_rad, double variance);
  /// Driving backwards (velocity opposite to the yaw) is understood.
  Outcome<double> correctByVelocity(double yaw_rad, const VelocityHeading& velocity);

  /// The yaw that a forward velocity speaks for, and its variance.
  [[nodiscard]] double yawOf(const VelocityHeading& velocity) const;
  [[nodiscard]] double varianceOf(const VelocityHeading& velocity) const;

  [[nodiscard]] double biasZ() const { return bias_radps_; }
  [[nodiscard]] double imuToRearAxle() const { return axle_m_; }
  [[nodiscard]] double yawVariance() const { return P_(kYaw, kYaw); }
  [[nodiscard]] double biasVariance() const { return P_(kBias, kBias); }

 private:
  enum Index { kYaw, kBias, kAxle, kGnss, kSize };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  void uncorrelate(Index index, double variance);
  Outcome<double> correct(double innovation, const Vector& H, double variance);

  HeadingParams params_;
  bool known_ = false;
  double bias_radps_ = 0.0;
  double axle_m_;
  double gnss_slow_rad_ = 0.0;
  double gnss_slow_variance_ = 0.0;  ///< stationary variance of the slow error
  double since_velocity_s_ = 0.0;    ///< time since the last velocity heading
  Matrix P_ = Matrix::Zero();
};

}  // namespace atlas
