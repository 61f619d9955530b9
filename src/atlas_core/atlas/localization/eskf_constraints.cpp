// SPDX-License-Identifier: MIT
// What is known without a receiver, five times a second: a vehicle that stands does not move, one that drives
// does not slip or hop, and the IMU's own roll and pitch are right in the long run. And height by air
// pressure.
#include <algorithm>
#include <cmath>

#include "atlas/localization/eskf_filter.hpp"

namespace atlas {
namespace {

using eskf::Index;

constexpr int kBlocksToStand = 2;                // the end of braking looks like standing
constexpr double kStillRate_radps = 0.01;        // mean rate, bias taken out
constexpr double kStillGyroSpread_radps = 0.03;  // engine vibration passes
constexpr double kStillForceSpread_mps2 = 0.6;
constexpr double kStillForceStep_mps2 = 0.03;  // change of the mean from block to block
constexpr double kStillSpeed_mps = 0.15;
constexpr double kSureSpeed_mps = 0.2;  // standard deviation: a better known speed decides alone
constexpr double kQuietFactor = 1.5;    // else the signal must be as quiet as when surely standing
constexpr double kMinWheelsSpeed_mps = 1.0;
constexpr double kConstraintGate = 30.0;            // chi-square, 2 and 3 dof: below 1e-6
constexpr double kSuspension_rad_per_mps2 = 0.006;  // pitch of a car when braking
constexpr double kScaleGain = 0.05, kMostScale = 1e4;
constexpr double kQuantization_radps = 1e-4;
constexpr double kUpTime_s = 20.0;  // the slow error of the IMU's own roll and pitch
constexpr Duration kUpPeriod = kSecond;

}  // namespace

void EskfFilter::constrain(const ImuMonitor::Block& block, const ImuSample& sample) {
  still_blocks_ = looksStill(block) ? still_blocks_ + 1 : 0;
  if (still_blocks_ >= kBlocksToStand) {
    useStanding(block);
  } else if (still_blocks_ == 0) {
    useWheels();
  }
  block_before_ = block;
  if (sample.orientation && sample.stamp >= next_up_) {
    useUp(*sample.orientation);
    next_up_ = sample.stamp + kUpPeriod;
  }
}

bool EskfFilter::looksStill(const ImuMonitor::Block& block) const {
  if (!block_before_) return false;
  const double step_noise = 3.0 * std::hypot(block.force_spread_mps2, block_before_->force_spread_mps2) /
                            std::sqrt(static_cast<double>(block.samples));
  const Eigen::Vector3d force = block.force_mps2 - state_.accel_bias;
  const bool quiet =
      (block.gyro_radps - state_.gyro_bias).norm() < kStillRate_radps &&
      block.gyro_spread_radps < kStillGyroSpread_radps && block.force_spread_mps2 < kStillForceSpread_mps2 &&
      (block.force_mps2 - block_before_->force_mps2).norm() < kStillForceStep_mps2 + step_noise &&
      std::abs(force.norm() - earth_.gravity_mps2) < 0.5;
  if (!quiet) return false;
  const double sigma = std::sqrt(P_.block<3, 3>(Index::kV, Index::kV).trace());
  if (state_.v.norm() > kStillSpeed_mps + 3.0 * sigma) return false;
  if (sigma < kSureSpeed_mps) return true;
  return block.force_spread_mps2 < kQuietFactor * still_force_spread_ &&
         block.gyro_spread_radps < kQuietFactor * still_gyro_spread_;
}

void EskfFilter::useStanding(const ImuMonitor::Block& block) {
  const double sigma = params_.eskf.standing_sigma_mps;
  if (!apply<3>("standing", eskf::standingMeasurement(state_, sigma * sigma), kConstraintGate)) {
    standing_outlier_.add(counters_);
    return;
  }
  standing_used_.add(counters_);
  const double density = std::max(params_.eskf.gyroscope_noise_radps_sqrt_hz, monitor_.gyroDensity());
  const double variance = 2.0 * density * density / block.span_s + kQuantization_radps * kQuantization_radps;
  apply<3>("not turning", eskf::notTurningMeasurement(state_, earth_, block.gyro_radps, variance),
           kConstraintGate);
  if (std::sqrt(P_.block<3, 3>(Index::kV, Index::kV).trace()) < kSureSpeed_mps) {
    still_force_spread_ = std::max(0.9 * still_force_spread_, block.force_spread_mps2);
    still_gyro_spread_ = std::max(0.9 * still_gyro_spread_, block.gyro_spread_radps);
  }
}

void EskfFilter::useWheels() {
  const Eigen::AngleAxisd R_vehicle_imu(-state_.mounted_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d u = R_vehicle_imu * (state_.R.conjugate() * state_.v);
  if (std::abs(u.x()) < kMinWheelsSpeed_mps) return;
  const EskfParams& e = params_.eskf;
  const Eigen::Vector3d w = R_vehicle_imu * rate();
  const double braking = (R_vehicle_imu * (current_->linear_acceleration_mps2 - state_.accel_bias)).x();
  const double common = std::pow(e.slip_sigma_mps, 2) + std::pow(e.slip_sigma_rad * u.x(), 2);
  const double slip = common + std::pow(e.axle_height_m * w.x(), 2);
  const double hop = 4.0 * common + std::pow(e.axle_height_m * w.y(), 2) +
                     std::pow(kSuspension_rad_per_mps2 * braking * u.x(), 2);
  const auto z = eskf::wheelsMeasurement(state_, rate(), wheels_scale_ * slip, wheels_scale_ * hop);
  const bool used = apply<2>("wheels", z, kConstraintGate);
  (used ? wheels_used_ : wheels_outlier_).add(counters_);
  // What is not a car (or slips more) shows while fixes say how it moves.
  if (toSeconds(current_->stamp - last_used_fix_) > 2.0) return;
  const double excess = std::min(last_mahalanobis_sq_ / 2.0, 10.0) - 1.0;
  wheels_scale_ = std::clamp(wheels_scale_ * std::exp(kScaleGain * excess), 1.0, kMostScale);
}

void EskfFilter::useUp(const Eigen::Quaterniond& R_enu_imu) {
  // Its slow error taken as white: the density of a first-order Gauss-Markov process is 2 sigma^2 T.
  const double sigma = params_.tilt_sigma_rad;
  const double variance = sigma * sigma * std::max(1.0, 2.0 * kUpTime_s / toSeconds(kUpPeriod));
  const Eigen::Vector3d up_imu = R_enu_imu.conjugate() * Eigen::Vector3d::UnitZ();
  const bool used =
      apply<2>("up", eskf::upMeasurement(state_, up_imu, earth_.up(state_.p), variance), kConstraintGate);
  (used ? up_used_ : up_outlier_).add(counters_);
}

void EskfFilter::updateHeight(Stamp stamp, double z_map_m, double variance_m2) {
  enqueue({stamp, MeasurementQueue::Height{z_map_m, variance_m2}});
}

void EskfFilter::use(Stamp /*stamp*/, const MeasurementQueue::Height& height) {
  if (!running_) return height_alone_.add(counters_);
  const auto z = eskf::heightMeasurement(state_, height.z_map_m, height.variance);
  (apply<1>("pressure", z, params_.heading_gate_mahalanobis_sq) ? height_used_ : height_outlier_)
      .add(counters_);
}

}  // namespace atlas
