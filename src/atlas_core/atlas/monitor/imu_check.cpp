// SPDX-License-Identifier: MIT
#include "atlas/monitor/imu_check.hpp"

#include <cmath>
#include <stdexcept>

namespace atlas {
namespace {
constexpr double kGravity_mps2 = 9.81;
constexpr int kGravityBlocks = 10, kBiasBlocks = 5;               // of 0.2 s
constexpr double kStillForce_mps2 = 1.0, kStillGyro_radps = 0.1;  // spread of an idling engine, with room
constexpr double kBiasGain = 0.2;

ImuGuardParams guardParams(const AnomalyThresholds& thresholds) {
  ImuGuardParams params;
  params.accelerometer_range_mps2 = thresholds[Anomaly::kAccelerometerSaturated];
  params.gyroscope_range_radps = thresholds[Anomaly::kGyroscopeSaturated];
  params.frozen_after_s = thresholds[Anomaly::kImuFrozen];
  return params;
}
}  // namespace

ImuCheck::ImuCheck(const AnomalyThresholds& thresholds) : guard_(guardParams(thresholds), counters_) {}

void ImuCheck::add(const ImuSample& sample, bool standing, Findings& findings) {
  const bool finite =
      sample.angular_velocity_radps.allFinite() && sample.linear_acceleration_mps2.allFinite();
  findings.measure(Anomaly::kNotFinite, sample.stamp, finite ? 0.0 : 1.0);
  if (!finite) return;
  ask(sample, findings);
  const auto block = monitor_.add(sample);
  if (!block) return;
  measureGravity(*block, sample.stamp, findings);
  measureBias(*block, standing, sample.stamp, findings);
}

void ImuCheck::ask(const ImuSample& sample, Findings& findings) {
  if (!units_wrong_) {
    try {
      guard_.usable(sample);
    } catch (const std::runtime_error&) {
      units_wrong_ = true;  // for good: it does not judge them again
    }
  }
  const ImuGuard::Verdict& verdict = guard_.verdict();
  const double force = sample.linear_acceleration_mps2.cwiseAbs().maxCoeff();
  const double rate = sample.angular_velocity_radps.cwiseAbs().maxCoeff();
  const auto judge = [&](Anomaly anomaly, bool present, double value) {
    findings.judge(anomaly, sample.stamp, present, value, findings.threshold(anomaly));
  };
  judge(Anomaly::kImuUnits, units_wrong_, 1.0);
  judge(Anomaly::kImuFrozen, verdict.frozen, findings.threshold(Anomaly::kImuFrozen));
  judge(Anomaly::kAccelerometerSaturated, verdict.accelerometer_saturated, force);
  judge(Anomaly::kGyroscopeSaturated, verdict.gyroscope_saturated, rate);
  judge(Anomaly::kImuBeyond, verdict.beyond, 1.0);
}

void ImuCheck::measureGravity(const ImuMonitor::Block& block, Stamp stamp, Findings& findings) {
  force_sum_ += block.force_mps2;
  if (++force_blocks_ < kGravityBlocks) return;
  findings.measure(Anomaly::kGravity, stamp, std::abs((force_sum_ / force_blocks_).norm() - kGravity_mps2));
  force_sum_.setZero();
  force_blocks_ = 0;
}

void ImuCheck::measureBias(const ImuMonitor::Block& block, bool standing, Stamp stamp, Findings& findings) {
  if (!standing || block.force_spread_mps2 > kStillForce_mps2 || block.gyro_spread_radps > kStillGyro_radps) {
    gyro_sum_.setZero();
    standing_blocks_ = 0;
    return;
  }
  gyro_sum_ += block.gyro_radps;
  if (++standing_blocks_ < kBiasBlocks) return;
  const Eigen::Vector3d mean = gyro_sum_ / standing_blocks_;
  gyro_sum_.setZero();
  standing_blocks_ = 0;
  if (!standing_gyro_radps_) standing_gyro_radps_ = mean;
  const double jump = (mean - *standing_gyro_radps_).norm();
  findings.measure(Anomaly::kGyroBias, stamp, jump);
  if (jump <= findings.threshold(Anomaly::kGyroBias))
    *standing_gyro_radps_ += kBiasGain * (mean - *standing_gyro_radps_);
}

}  // namespace atlas
