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
constexpr double kMovingTilt_rad = 0.15;     // error of gravity's mean direction while driving
constexpr double kStillSpeed_mps = 0.3, kStillSpeedSigma_mps = 0.5;
constexpr double kStillRate_radps = 0.06;  // bias of a consumer gyroscope; slower than any turn in traffic
constexpr double kStillRateStep_radps = 0.003, kStillForceStep_mps2 = 0.05;  // from block to block
constexpr double kStillGyroSpread_radps = 0.03, kStillForceSpread_mps2 = 0.6;
constexpr int kBlocksToStand = 3;
constexpr double kBiasHolds_s = 60.0;    // for so long after standing
constexpr double kHeldTilt_rad = 0.005;  // the springs of a standing car; what scale errors of a turn add
constexpr double kStoodBias_radps = 2e-4;
constexpr double kMatchSpeed_mps = 0.5;  // standard deviation of a velocity to begin with
constexpr double kMatchLeast_s = 0.8, kMatchMost_s = 2.5;
constexpr double kMaxHeadingAge_s = 2.0;
constexpr double kMountedForward_rad = 0.4;  // within it the filter's own mount angle does
constexpr double kReversed_rad = 2.4;        // beyond it: mounted backwards, or the car reverses
constexpr double kReversedAxle_m = 2.0;      // standard deviation of where the axle is, then
}  // namespace

Start::Start(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu, const Earth& earth)
    : params_(params), lever_(lever_arm_imu), earth_(earth) {}

void Start::move(Stamp stamp, const Inertial& first, const Inertial& second, double dt_s) {
  const Eigen::Vector3d rate = 0.5 * (first.rate_radps + second.rate_radps) - gyro_bias_;
  elapsed_s_ += dt_s;
  ImuSample sample;
  sample.stamp = stamp;
  sample.angular_velocity_radps = second.rate_radps;
  sample.linear_acceleration_mps2 = second.force_mps2;
  if (const auto block = monitor_.add(sample)) watchStanding(*block);
  const Eigen::Quaterniond back = expSo3(-dt_s * rate);
  if (!own_up_) {
    const bool held = still_s_ > 0.0 && still_blocks_ == 0 && unstill_s_ < kBiasHolds_s;
    const double memory = std::min(std::max(elapsed_s_, dt_s), kGravityMemory_s);
    up_imu_ = back * up_imu_;
    if (!held) up_imu_ += dt_s / memory * (second.force_mps2 / earth_.gravity_mps2 - up_imu_);
  }
  unstill_s_ += dt_s;
  mount_.move(back, second.force_mps2, dt_s);
  impulse_imu_ = back * impulse_imu_ + dt_s * second.force_mps2;
  matched_s_ += dt_s;
  if (heading_) {
    heading_age_s_ += dt_s;
    heading_->yaw_rad += dt_s * rate.dot(up_imu_.normalized());
    if (heading_age_s_ > kMaxHeadingAge_s) heading_.reset();
  }
  if (!located_) return;
  for (Kalman1dAxis& axis : axes_) axis.predict(dt_s, {0.0, kCarNoise_sq, 0.0, 60.0});
}

double Start::velocityVariance() const {
  return std::max(axes_[0].covariance()(1, 1), axes_[1].covariance()(1, 1));
}

Eigen::Vector3d Start::velocity() const {
  return {axes_[0].velocity(), axes_[1].velocity(), axes_[2].velocity()};
}

void Start::watchStanding(const ImuMonitor::Block& block) {
  const double root = std::sqrt(static_cast<double>(block.samples));
  const bool still = located_ && velocityVariance() < kStillSpeedSigma_mps * kStillSpeedSigma_mps &&
                     velocity().head<2>().norm() < kStillSpeed_mps &&
                     block.gyro_radps.norm() < kStillRate_radps &&
                     block.gyro_spread_radps < kStillGyroSpread_radps &&
                     block.force_spread_mps2 < kStillForceSpread_mps2 && block_before_ &&
                     (block.gyro_radps - block_before_->gyro_radps).norm() <
                         kStillRateStep_radps + 4.0 * block.gyro_spread_radps / root &&
                     (block.force_mps2 - block_before_->force_mps2).norm() <
                         kStillForceStep_mps2 + 4.0 * block.force_spread_mps2 / root;
  // The newest block may be the first of the drive: the one before it is used.
  const bool used = still && ++still_blocks_ >= kBlocksToStand;
  if (!still) still_blocks_ = 0;
  if (used) {
    if (unstill_s_ > kBiasHolds_s) still_s_ = 0.0;
    still_s_ += block_before_->span_s;
    gyro_bias_ += block_before_->span_s / still_s_ * (block_before_->gyro_radps - gyro_bias_);
    unstill_s_ = 0.0;
  }
  block_before_ = block;
}

void Start::matchVelocity() {
  if (matching_ && matched_s_ < kMatchMost_s) return;
  if (!matching_ && velocityVariance() > kMatchSpeed_mps * kMatchSpeed_mps) return;
  matching_ = true;
  matched_s_ = 0.0;
  impulse_imu_.setZero();
  v0_ = velocity();
  v0_variance_ = velocityVariance();
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
  matchVelocity();
  mount_.velocity(velocity(), velocityVariance(), up_imu_.normalized());
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

double Start::mounted() const {
  const double angle = mount_.angle().value_or(0.0);
  return std::abs(angle) < kMountedForward_rad ? 0.0 : angle;
}

std::optional<double> Start::seenYaw() const {
  const std::optional<Yaw> along = course();
  if (!along || !mount_.angle()) return std::nullopt;
  return wrapAngle(along->yaw_rad - mounted());
}

Start::Up Start::up(double yaw_rad) const {
  if (own_up_) return {up_imu_.normalized(), params_.tilt_sigma_rad * params_.tilt_sigma_rad};
  const double speed = velocity().norm();
  Up best{up_imu_.normalized(), std::pow(std::min(1.0, speed) * kMovingTilt_rad, 2)};
  if (still_s_ > 0.0 && unstill_s_ < kBiasHolds_s) best.variance = kHeldTilt_rad * kHeldTilt_rad;
  if (!matching_ || matched_s_ < kMatchLeast_s) return best;
  const double variance = (velocityVariance() + v0_variance_) / std::pow(matched_s_ * earth_.gravity_mps2, 2);
  if (variance > best.variance) return best;
  const Eigen::Vector3d force = impulse_imu_ / matched_s_;
  const Eigen::Vector3d motion =
      (velocity() - v0_) / matched_s_ + earth_.gravity_mps2 * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d d = Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ()) * motion.normalized();
  // Roll about x brings the force's y to d_y, pitch about y the rest.
  const Eigen::Vector3d f = force.normalized();
  const double level = std::hypot(f.y(), f.z());
  const double roll = std::acos(std::clamp(d.y() / level, -1.0, 1.0)) - std::atan2(f.z(), f.y());
  const double z = std::sin(roll) * f.y() + std::cos(roll) * f.z();
  const double pitch = std::atan2(d.x(), d.z()) - std::atan2(f.x(), z);
  return {fromRollPitchYaw({roll, pitch, 0.0}).conjugate() * Eigen::Vector3d::UnitZ(), variance};
}

std::optional<Start::Result> Start::result(const Inertial& now) const {
  if (!located_ || !upKnown()) return std::nullopt;
  for (const Kalman1dAxis& axis : axes_) {
    if (axis.covariance()(1, 1) > kKnownSpeed_mps * kKnownSpeed_mps) return std::nullopt;
  }
  const EskfParams& e = params_.eskf;
  const Eigen::Vector3d v_antenna = velocity();
  std::optional<Yaw> yaw = heading_;
  if (!yaw) {
    const double bend = now.rate_radps.norm() * (lever_.norm() + std::abs(params_.imu_to_rear_axle_m));
    if (bend > kMaxLeverCourse_rad * v_antenna.norm()) return std::nullopt;
    yaw = course();
    if (yaw) yaw->yaw_rad = wrapAngle(yaw->yaw_rad - mounted());
    if (yaw) yaw->variance += e.mount_sigma_rad * e.mount_sigma_rad + 0.25 * std::pow(kMaxLeverCourse_rad, 2);
  }
  if (!yaw) return std::nullopt;

  Result result;
  State& s = result.state;
  result.from_velocity = !heading_;
  // Roll and pitch: the rotation that takes "up" of the imu to that of map, then the yaw.
  const Up gravity = up(yaw->yaw_rad);
  const Eigen::Vector3d& up = gravity.direction_imu;
  const double roll = std::atan2(up.y(), up.z()), pitch = std::asin(std::clamp(-up.x(), -1.0, 1.0));
  s.R = fromRollPitchYaw({roll, pitch, yaw->yaw_rad});
  s.lever = lever_;
  s.axle_m = params_.imu_to_rear_axle_m;
  if (!heading_) s.mounted_rad = mounted();
  s.p = Eigen::Vector3d(axes_[0].position(), axes_[1].position(), axes_[2].position()) - s.R * lever_;
  s.v = v_antenna - s.R * now.rate_radps.cross(lever_);

  s.gyro_bias = gyro_bias_;
  // The mean of standing errs by its noise, slow changes and the Earth's rotation.
  const double stood = still_s_ > 0.0 ? kStoodBias_radps * kStoodBias_radps * (1.0 + 1.0 / still_s_) : 1.0;
  const double gyro_variance = std::min(std::pow(e.gyroscope_bias_radps, 2), stood);

  Matrix& P = result.P;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix2d axis = axes_[static_cast<std::size_t>(i)].covariance();
    P(kP + i, kP + i) = axis(0, 0);
    P(kP + i, kV + i) = P(kV + i, kP + i) = axis(0, 1);
    P(kV + i, kV + i) = axis(1, 1);
    P(kGyro + i, kGyro + i) = gyro_variance;
    P(kAccel + i, kAccel + i) = e.accelerometer_bias_mps2 * e.accelerometer_bias_mps2;
    P(kLever + i, kLever + i) = e.lever_arm_sigma_m * e.lever_arm_sigma_m;
  }
  if (own_up_) {
    P(kTheta, kTheta) = P(kTheta + 1, kTheta + 1) = gravity.variance;
  } else {  // the accelerometer's bias has tilted it
    Eigen::Matrix3d tilt = Eigen::Matrix3d::Zero();
    tilt.topRows<2>() << -s.R.toRotationMatrix().row(1), s.R.toRotationMatrix().row(0);
    tilt /= earth_.gravity_mps2;
    const Eigen::Matrix3d bias = P.block<3, 3>(kAccel, kAccel);
    P.block<3, 3>(kTheta, kTheta) = tilt * bias * tilt.transpose();
    P(kTheta, kTheta) += gravity.variance;
    P(kTheta + 1, kTheta + 1) += gravity.variance;
    P.block<3, 3>(kTheta, kAccel) = tilt * bias;
    P.block<3, 3>(kAccel, kTheta) = (tilt * bias).transpose();
  }
  P(kTheta + 2, kTheta + 2) += yaw->variance;
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
  P.block<3, 3>(kP, kAccel) = J * P.block<3, 3>(kTheta, kAccel);
  P.block<3, 3>(kAccel, kP) = P.block<3, 3>(kP, kAccel).transpose();
  P.block<3, 1>(kP, kHeadingSlow) = -shared * J.col(2);
  P.block<1, 3>(kHeadingSlow, kP) = -shared * J.col(2).transpose();
  P(kMountYaw, kMountYaw) = P(kMountPitch, kMountPitch) = e.mount_sigma_rad * e.mount_sigma_rad;
  const double axle_sigma =
      std::abs(s.mounted_rad) > kReversed_rad ? kReversedAxle_m : params_.imu_to_rear_axle_sigma_m;
  P(kAxle, kAxle) = axle_sigma * axle_sigma;
  P(kDelay, kDelay) = e.gnss_delay_sigma_s * e.gnss_delay_sigma_s;
  return result;
}

}  // namespace atlas::eskf
