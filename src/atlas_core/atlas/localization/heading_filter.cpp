// SPDX-License-Identifier: MIT
#include "atlas/localization/heading_filter.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/base/geometry.hpp"

namespace atlas {
namespace {
// Velocity errors and slip of consecutive fixes are correlated over about this time (the position filters'
// own time constant): N updates within it count as one, whatever the rate.
constexpr double kVelocityCorrelation_s = 0.6;
double square(double x) { return x * x; }
}  // namespace

HeadingFilter::HeadingFilter(const HeadingParams& params)
    : params_(params), axle_m_(params.imu_to_rear_axle_m) {
  P_(kBias, kBias) = square(params.gyroscope_bias_radps);
  P_(kAxle, kAxle) = square(params.imu_to_rear_axle_sigma_m);
}

void HeadingFilter::uncorrelate(Index index, double variance) {
  P_.row(index).setZero();
  P_.col(index).setZero();
  P_(index, index) = variance;
}

void HeadingFilter::initializeFromGnss(double variance) {
  gnss_slow_variance_ = params_.gnss_slow_share * variance;
  gnss_slow_rad_ = 0.0;
  uncorrelate(kYaw, variance);
  uncorrelate(kGnss, gnss_slow_variance_);
  // yaw error = slow + white error of the measurement, with opposite sign of the slow state's own error
  P_(kYaw, kGnss) = P_(kGnss, kYaw) = -gnss_slow_variance_;
  known_ = true;
}

void HeadingFilter::initializeFromVelocity(const VelocityHeading& velocity, double gnss_variance) {
  gnss_slow_variance_ = params_.gnss_slow_share * gnss_variance;
  gnss_slow_rad_ = 0.0;
  uncorrelate(kYaw, varianceOf(velocity));
  uncorrelate(kGnss, gnss_slow_variance_);
  since_velocity_s_ = 0.0;
  known_ = true;
}

void HeadingFilter::forget() {
  known_ = false;
  uncorrelate(kBias, square(params_.gyroscope_bias_radps));
}

void HeadingFilter::predict(double dt_s) {
  const double phi = std::exp(-dt_s / params_.gnss_slow_time_s);
  Matrix F = Matrix::Identity();
  F(kYaw, kBias) = -dt_s;
  F(kGnss, kGnss) = phi;
  gnss_slow_rad_ *= phi;
  P_ = F * P_ * F.transpose();
  const double walk_sq = square(params_.gyroscope_bias_walk_radps2_sqrt_hz);
  P_(kYaw, kYaw) += square(params_.gyroscope_noise_radps_sqrt_hz) * dt_s + walk_sq * dt_s * dt_s * dt_s / 3.0;
  P_(kYaw, kBias) -= walk_sq * dt_s * dt_s / 2.0;
  P_(kBias, kYaw) = P_(kYaw, kBias);
  P_(kBias, kBias) += walk_sq * dt_s;
  P_(kGnss, kGnss) += (1.0 - phi * phi) * gnss_slow_variance_;
  since_velocity_s_ += dt_s;
}

Outcome<double> HeadingFilter::correct(double innovation, const Vector& H, double variance) {
  const double S = H.dot(P_ * H) + variance;
  if (innovation * innovation > params_.gate_mahalanobis_sq * S) return Reason::kLowQuality;
  const Vector K = P_ * H / S;
  const Matrix I_KH = Matrix::Identity() - K * H.transpose();
  P_ = I_KH * P_ * I_KH.transpose() + variance * K * K.transpose();  // Joseph form
  P_ = 0.5 * (P_ + P_.transpose()).eval();
  bias_radps_ += K(kBias) * innovation;
  axle_m_ += K(kAxle) * innovation;
  gnss_slow_rad_ += K(kGnss) * innovation;
  return K(kYaw) * innovation;
}

Outcome<double> HeadingFilter::correctByGnss(double yaw_rad, double measured_rad, double variance) {
  gnss_slow_variance_ = params_.gnss_slow_share * variance;
  Vector H = Vector::Zero();
  H(kYaw) = H(kGnss) = 1.0;
  return correct(wrapAngle(measured_rad - yaw_rad - gnss_slow_rad_), H, variance - gnss_slow_variance_);
}

Outcome<double> HeadingFilter::correctByVelocity(double yaw_rad, const VelocityHeading& velocity) {
  const bool backwards = std::cos(velocity.course_rad - yaw_rad) < 0.0;
  const double course = backwards ? velocity.course_rad + M_PI : velocity.course_rad;
  const double signed_speed = backwards ? -velocity.speed_mps : velocity.speed_mps;
  Vector H = Vector::Zero();
  H(kYaw) = 1.0;
  H(kAxle) = velocity.yaw_rate_radps / signed_speed;
  const double innovation = wrapAngle(course - yaw_rad - axle_m_ * H(kAxle));
  const double correlated = std::max(1.0, kVelocityCorrelation_s / std::max(since_velocity_s_, 1e-3));
  const double variance = (velocity.course_variance + square(params_.slip_rad)) * correlated;
  const Outcome<double> turn = correct(innovation, H, variance);
  if (turn) since_velocity_s_ = 0.0;
  return turn;
}

double HeadingFilter::yawOf(const VelocityHeading& velocity) const {
  return wrapAngle(velocity.course_rad - axle_m_ * velocity.yaw_rate_radps / velocity.speed_mps);
}

double HeadingFilter::varianceOf(const VelocityHeading& velocity) const {
  const double lever = velocity.yaw_rate_radps / velocity.speed_mps;
  return velocity.course_variance + square(params_.slip_rad) + square(lever) * P_(kAxle, kAxle);
}

}  // namespace atlas
