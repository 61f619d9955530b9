// SPDX-License-Identifier: MIT
#include "atlas/localization/eskf_start.hpp"

#include <algorithm>
#include <cmath>

namespace atlas::eskf {
namespace {
constexpr double kUnknownSpeed_mps = 30.0;   // standard deviation of a velocity nobody measured yet
constexpr double kKnownSpeed_mps = 2.0;      // the velocity is known below this standard deviation
constexpr double kCarNoise_sq = 1.0;         // (m/s^2)^2/Hz: a vehicle's acceleration
constexpr double kGravityMemory_s = 10.0;    // longer than accelerating or turning lasts
constexpr double kMaxCourse_rad = 0.2618;    // 15 deg: a worse course does not start a heading
constexpr double kMinCourseSpeed_mps = 1.0;  // below it lever arm and sway make the course
constexpr double kMaxLeverCourse_rad = 0.1;  // by which a turn changes the course between antenna and imu
constexpr double kMovingTilt_rad = 0.05;     // error of gravity's mean direction while driving
constexpr double kMaxHeadingAge_s = 2.0;
}  // namespace

Start::Start(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu, const Earth& earth)
    : params_(params), lever_(lever_arm_imu), earth_(earth) {}

void Start::move(const Inertial& first, const Inertial& second, double dt_s) {
  const Eigen::Vector3d rate = 0.5 * (first.rate_radps + second.rate_radps);
  elapsed_s_ += dt_s;
  if (!own_up_) {
    const double gain = dt_s / std::min(std::max(elapsed_s_, dt_s), kGravityMemory_s);
    up_imu_ = expSo3(-dt_s * rate) * up_imu_;
    up_imu_ += gain * (second.force_mps2 / earth_.gravity_mps2 - up_imu_);
  }
  if (heading_) {
    heading_age_s_ += dt_s;
    heading_->yaw_rad += dt_s * rate.dot(up_imu_.normalized());
    if (heading_age_s_ > kMaxHeadingAge_s) heading_.reset();
  }
  if (!located_) return;
  for (Kalman1dAxis& axis : axes_) axis.predict(dt_s, {0.0, kCarNoise_sq, 0.0, 60.0});
}

void Start::orientation(const Eigen::Quaterniond& R_enu_imu) {
  up_imu_ = R_enu_imu.conjugate() * Eigen::Vector3d::UnitZ();
  own_up_ = true;
}

void Start::fix(const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2) {
  for (int i = 0; i < 3; ++i) {
    Kalman1dAxis& axis = axes_[static_cast<std::size_t>(i)];
    if (located_ && axis.mahalanobisSq(p_map_antenna(i), R_m2(i, i)) < params_.gate_mahalanobis_sq) {
      axis.correct(p_map_antenna(i), R_m2(i, i));
    } else {
      axis.initialize(p_map_antenna(i), R_m2(i, i), 0.0, kUnknownSpeed_mps * kUnknownSpeed_mps, 0.0);
    }
  }
  located_ = true;
}

void Start::heading(double yaw_rad, double variance) {
  heading_ = Yaw{yaw_rad, variance};
  heading_age_s_ = 0.0;
}

std::optional<Start::Yaw> Start::course() const {
  const Eigen::Vector2d v(axes_[0].velocity(), axes_[1].velocity());
  const double speed = v.norm();
  if (speed < kMinCourseSpeed_mps) return std::nullopt;
  const double east = axes_[0].covariance()(1, 1), north = axes_[1].covariance()(1, 1);
  const double variance = (east * v.y() * v.y() + north * v.x() * v.x()) / std::pow(speed, 4);
  if (variance > kMaxCourse_rad * kMaxCourse_rad) return std::nullopt;
  return Yaw{std::atan2(v.y(), v.x()), variance};
}

std::optional<Start::Result> Start::result(const Inertial& now) const {
  if (!located_ || !upKnown()) return std::nullopt;
  for (const Kalman1dAxis& axis : axes_) {
    if (axis.covariance()(1, 1) > kKnownSpeed_mps * kKnownSpeed_mps) return std::nullopt;
  }
  const EskfParams& e = params_.eskf;
  const Eigen::Vector3d v_antenna(axes_[0].velocity(), axes_[1].velocity(), axes_[2].velocity());
  std::optional<Yaw> yaw = heading_;
  if (!yaw) {
    const double bend = now.rate_radps.norm() * (lever_.norm() + std::abs(params_.imu_to_rear_axle_m));
    if (bend > kMaxLeverCourse_rad * v_antenna.norm()) return std::nullopt;
    yaw = course();
    if (yaw) yaw->variance += e.mount_sigma_rad * e.mount_sigma_rad + 0.25 * std::pow(kMaxLeverCourse_rad, 2);
  }
  if (!yaw) return std::nullopt;

  Result result;
  State& s = result.state;
  result.from_velocity = !heading_;
  // Roll and pitch: the rotation that takes "up" of the imu to that of map, then the yaw.
  const Eigen::Vector3d up = up_imu_.normalized();
  const double roll = std::atan2(up.y(), up.z()), pitch = std::asin(std::clamp(-up.x(), -1.0, 1.0));
  s.R = fromRollPitchYaw({roll, pitch, yaw->yaw_rad});
  s.lever = lever_;
  s.axle_m = params_.imu_to_rear_axle_m;
  s.p = Eigen::Vector3d(axes_[0].position(), axes_[1].position(), axes_[2].position()) - s.R * lever_;
  s.v = v_antenna - s.R * now.rate_radps.cross(lever_);

  Matrix& P = result.P;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix2d axis = axes_[static_cast<std::size_t>(i)].covariance();
    P(kP + i, kP + i) = axis(0, 0);
    P(kP + i, kV + i) = P(kV + i, kP + i) = axis(0, 1);
    P(kV + i, kV + i) = axis(1, 1);
    P(kGyro + i, kGyro + i) = e.gyroscope_bias_radps * e.gyroscope_bias_radps;
    P(kAccel + i, kAccel + i) = e.accelerometer_bias_mps2 * e.accelerometer_bias_mps2;
    P(kLever + i, kLever + i) = e.lever_arm_sigma_m * e.lever_arm_sigma_m;
  }
  const double still = e.accelerometer_bias_mps2 / earth_.gravity_mps2;
  const double moving = std::min(1.0, v_antenna.norm()) * kMovingTilt_rad;
  const double tilt =
      own_up_ ? params_.tilt_sigma_rad * params_.tilt_sigma_rad : still * still + moving * moving;
  P(kTheta, kTheta) = P(kTheta + 1, kTheta + 1) = tilt;
  P(kTheta + 2, kTheta + 2) = yaw->variance;
  const double slow =
      params_.gnss_heading_slow_share * params_.gnss_heading_sigma_rad * params_.gnss_heading_sigma_rad;
  P(kHeadingSlow, kHeadingSlow) = slow;
  // The heading was taken as true: its slow error is in the attitude, with the other sign.
  const double shared = heading_ ? std::min(slow, 0.99 * yaw->variance) : 0.0;
  P(kTheta + 2, kHeadingSlow) = P(kHeadingSlow, kTheta + 2) = -shared;
  // A wrong attitude misplaces the imu by theta x (R l).
  const Eigen::Matrix3d J = skew(s.R * lever_);
  const Eigen::Matrix3d theta = P.block<3, 3>(kTheta, kTheta);
  P.block<3, 3>(kP, kP) += J * theta * J.transpose();
  P.block<3, 3>(kP, kTheta) = J * theta;
  P.block<3, 3>(kTheta, kP) = (J * theta).transpose();
  P.block<3, 1>(kP, kHeadingSlow) = -shared * J.col(2);
  P.block<1, 3>(kHeadingSlow, kP) = -shared * J.col(2).transpose();
  P(kMountYaw, kMountYaw) = P(kMountPitch, kMountPitch) = e.mount_sigma_rad * e.mount_sigma_rad;
  P(kAxle, kAxle) = params_.imu_to_rear_axle_sigma_m * params_.imu_to_rear_axle_sigma_m;
  P(kDelay, kDelay) = e.gnss_delay_sigma_s * e.gnss_delay_sigma_s;
  return result;
}

}  // namespace atlas::eskf
