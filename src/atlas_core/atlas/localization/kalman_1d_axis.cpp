// SPDX-License-Identifier: MIT
#include "atlas/localization/kalman_1d_axis.hpp"

#include <cmath>

namespace atlas {

void Kalman1dAxis::initialize(double position_m, double position_variance, double velocity_mps,
                              double velocity_variance, double bias_variance) {
  x_ << position_m, velocity_mps;
  P_ = Eigen::Vector3d(position_variance, velocity_variance, bias_variance).asDiagonal();
}

void Kalman1dAxis::shift(double position_m, double position_variance, double velocity_mps,
                         double bias_variance) {
  x_ += Eigen::Vector2d(position_m, velocity_mps);
  P_(0, 0) += position_variance;
  P_.row(2).setZero();
  P_.col(2).setZero();
  P_(2, 2) = bias_variance;
}

void Kalman1dAxis::predict(double dt_s, const Input& input) {
  const double dt = dt_s, dt2 = dt * dt, dt3 = dt2 * dt;
  x_(0) += dt * x_(1) + 0.5 * dt2 * input.acceleration_mps2;
  x_(1) += dt * input.acceleration_mps2;

  const double phi = std::exp(-dt / input.bias_time_s);
  Eigen::Matrix3d F;  // of the errors of (p, v, b)
  F << 1.0, dt, 0.5 * dt2, 0.0, 1.0, dt, 0.0, 0.0, phi;
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  Q.topLeftCorner<2, 2>() << dt3 / 3.0, dt2 / 2.0, dt2 / 2.0, dt;
  Q *= input.noise_density_sq;
  Q(2, 2) = (1.0 - phi * phi) * input.bias_variance;
  P_ = F * P_ * F.transpose() + Q;
  P_ = 0.5 * (P_ + P_.transpose()).eval();  // rounding only
}

double Kalman1dAxis::mahalanobisSq(double measured_m, double variance_m2) const {
  const double innovation = measured_m - x_(0);
  return innovation * innovation / (P_(0, 0) + variance_m2);
}

void Kalman1dAxis::correct(double measured_m, double variance_m2) {
  const double innovation = measured_m - x_(0);
  const double S = P_(0, 0) + variance_m2;
  // The gain of b is zero: considered, not estimated. The Joseph form holds for any gain.
  const Eigen::Vector3d K(P_(0, 0) / S, P_(1, 0) / S, 0.0);
  x_ += K.head<2>() * innovation;
  Eigen::Matrix3d I_KH = Eigen::Matrix3d::Identity();
  I_KH.col(0) -= K;
  P_ = I_KH * P_ * I_KH.transpose() + variance_m2 * K * K.transpose();
  P_ = 0.5 * (P_ + P_.transpose()).eval();
}

}  // namespace atlas
