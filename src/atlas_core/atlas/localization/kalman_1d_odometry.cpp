// SPDX-License-Identifier: MIT
// What the composed filter says about itself: velocity, uncertainties, odometry.
#include <cmath>

#include "atlas/base/geometry.hpp"
#include "atlas/localization/kalman_1d_filter.hpp"

namespace atlas {
namespace {
constexpr double kEarthRadius_m = 6371000.0;
using Matrix3 = Eigen::Matrix3d;

void setBlock(std::array<double, 36>& covariance, int at, const Matrix3& block) {
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(covariance.data()).block<3, 3>(at, at) = block;
}
}  // namespace

Eigen::Vector3d Kalman1dFilter::velocity() const {
  return {axes_[0].velocity(), axes_[1].velocity(), axes_[2].velocity()};
}

Eigen::Vector3d Kalman1dFilter::upAt() const {
  // The vertical turns by 1 deg in 111 km; `map` is tangential at its origin.
  if (!located_) return Eigen::Vector3d::UnitZ();
  return Eigen::Vector3d(axes_[0].position(), axes_[1].position(), kEarthRadius_m).normalized();
}

Eigen::Matrix3d Kalman1dFilter::attitudeCovariance() const {
  return Eigen::Vector3d(attitude_.tiltVariance(), attitude_.tiltVariance(), heading_.yawVariance())
      .asDiagonal();
}

Eigen::Vector3d Kalman1dFilter::leverVariance() const {
  // R(theta) l errs by dtheta x (R l)
  const Matrix3 J = skew(attitude_.R_map_imu() * lever_arm_imu_);
  return (J * attitudeCovariance() * J.transpose()).diagonal();
}

Eigen::Vector3d Kalman1dFilter::biasVariance() const {
  // A tilt error lets gravity leak into the level axes: g dtheta.
  const double sensor = params_.accelerometer_bias_mps2 * params_.accelerometer_bias_mps2;
  const double level = sensor + gravity_mps2_ * gravity_mps2_ * attitude_.tiltVariance();
  return {level, level, sensor};
}

std::optional<VelocityHeading> Kalman1dFilter::velocityHeading() const {
  const Eigen::Vector3d v = velocity();
  const double speed = v.head<2>().norm();
  if (!velocity_known_ || speed < params_.velocity_heading_min_speed_mps) return std::nullopt;
  VelocityHeading heading;
  heading.course_rad = std::atan2(v.y(), v.x());
  heading.speed_mps = speed;
  // Variance across the direction of motion, over speed squared.
  const double east = axes_[0].covariance()(1, 1), north = axes_[1].covariance()(1, 1);
  heading.course_variance = (east * v.y() * v.y() + north * v.x() * v.x()) / std::pow(speed, 4);
  Eigen::Vector3d rate = current_->angular_velocity_radps - attitude_.bias_radps();
  heading.yaw_rate_radps = (attitude_.R_map_imu() * rate).z();
  return heading;
}

Odometry Kalman1dFilter::odometry(double dt_s) const {
  Odometry odometry;
  odometry.stamp = current_->stamp;
  const Eigen::Quaterniond& R_map_imu = attitude_.R_map_imu();
  odometry.T_map_imu = {R_map_imu, {axes_[0].position(), axes_[1].position(), axes_[2].position()}};
  odometry.velocity_imu_mps = R_map_imu.conjugate() * velocity();
  odometry.angular_velocity_imu_radps = current_->angular_velocity_radps - attitude_.bias_radps();

  Eigen::Vector3d p_variance, v_variance;
  for (std::size_t i = 0; i < 3; ++i) {
    p_variance(i) = axes_[i].covariance()(0, 0);
    v_variance(i) = axes_[i].covariance()(1, 1);
  }
  setBlock(odometry.pose_covariance, 0, p_variance.asDiagonal());
  setBlock(odometry.pose_covariance, 3, attitudeCovariance());
  // v_imu = R' v errs by R' (dv + v x dtheta)
  const Matrix3 R_imu_map = R_map_imu.conjugate().toRotationMatrix(), J = skew(velocity());
  const Matrix3 v_map = Matrix3(v_variance.asDiagonal()) + J * attitudeCovariance() * J.transpose();
  setBlock(odometry.twist_covariance, 0, R_imu_map * v_map * R_imu_map.transpose());
  const double white = params_.gyroscope_noise_radps_sqrt_hz * params_.gyroscope_noise_radps_sqrt_hz / dt_s;
  const double level = params_.gyroscope_bias_radps * params_.gyroscope_bias_radps;
  const Eigen::Vector3d rate(white + level, white + level, white + heading_.biasVariance());
  setBlock(odometry.twist_covariance, 3, rate.asDiagonal());
  return odometry;
}

}  // namespace atlas
