// SPDX-License-Identifier: MIT
// One of the three 1D Kalman filters of the paper (section IV-A): position and velocity along one axis of
// `map`, driven by acceleration, corrected by position.
//
//   model       x = [p v]',  p' = v,  v' = u + b + w
//               w: white, density q;  b: slow error of the acceleration (accelerometer bias, tilt times
//               gravity), a first-order Gauss-Markov process
//   prediction  x = A x + B u,  A = [1 dt; 0 1],  B = [dt^2/2; dt],  Q = q [dt^3/3 dt^2/2; dt^2/2 dt]
//               (Bar-Shalom, Li, Kirubarajan 2001, "Estimation with Applications to Tracking and Navigation",
//               eq. 6.2.2-4)
//   correction  K = P H' (H P H' + R)^-1,  P = (I - KH) P (I - KH)' + K R K'   (Joseph form: symmetric,
//   positive)
//
// b is not estimated (it turns with the vehicle, so it is no constant of an axis) but considered: its
// correlation with p and v is kept, so that the covariance stays honest in an outage (Schmidt 1966; Jazwinski
// 1970, section 8.4).
#pragma once

#include <Eigen/Core>

namespace atlas {

class Kalman1dAxis {
 public:
  /// Sets the state; it is uncorrelated, and the slow error starts with `bias_variance`.
  void initialize(double position_m, double position_variance, double velocity_mps, double velocity_variance,
                  double bias_variance);

  /// Moves the state to another point of the vehicle, whose offset has its own uncertainty, and starts the
  /// slow error anew.
  void shift(double position_m, double position_variance, double velocity_mps, double bias_variance);

  /// What drives the axis during one step.
  struct Input {
    double acceleration_mps2 = 0.0;
    double noise_density_sq = 0.0;  ///< q, (m/s^2)^2/Hz
    double bias_variance = 0.0;     ///< stationary variance of b, (m/s^2)^2
    double bias_time_s = 60.0;      ///< its correlation time
  };
  void predict(double dt_s, const Input& input);

  /// Squared distance of a measured position from the predicted one, in units of their common variance.
  [[nodiscard]] double mahalanobisSq(double measured_m, double variance_m2) const;
  void correct(double measured_m, double variance_m2);

  [[nodiscard]] double position() const { return x_(0); }
  [[nodiscard]] double velocity() const { return x_(1); }
  /// Covariance of (position, velocity).
  [[nodiscard]] Eigen::Matrix2d covariance() const { return P_.topLeftCorner<2, 2>(); }

 private:
  Eigen::Vector2d x_ = Eigen::Vector2d::Zero();
  Eigen::Matrix3d P_ = Eigen::Matrix3d::Zero();  ///< of the errors of (p, v, b)
};

}  // namespace atlas
