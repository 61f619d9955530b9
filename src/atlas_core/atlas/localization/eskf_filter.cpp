// SPDX-License-Identifier: MIT
// How time passes and measurements enter; the vehicle's constraints are in eskf_constraints.cpp, who is
// believed when fixes and state disagree in eskf_recovery.cpp, what comes out in eskf_odometry.cpp.
#include "atlas/localization/eskf_filter.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/base/check.hpp"

namespace atlas {
namespace {

constexpr double kGapPeriods = 5.0;            // so many sample periods without a sample are a gap ...
constexpr double kGapLeast_s = 0.02;           // ... if it is this long
constexpr double kGapAcceleration_mps2 = 1.5;  // what a vehicle may do in it
constexpr double kGapRate_radps = 0.2;
constexpr double kLongestGap_s = 30.0;  // after it nothing is known any more
constexpr double kRecoveredYaw_rad = 0.5;

eskf::Inertial inertial(const ImuSample& s) { return {s.angular_velocity_radps, s.linear_acceleration_mps2}; }

ImuSample interpolateAt(Stamp stamp, const ImuSample& a, const ImuSample& b) {
  const double ratio = static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  ImuSample sample;
  sample.stamp = stamp;
  sample.angular_velocity_radps = (1.0 - ratio) * a.angular_velocity_radps + ratio * b.angular_velocity_radps;
  sample.linear_acceleration_mps2 =
      (1.0 - ratio) * a.linear_acceleration_mps2 + ratio * b.linear_acceleration_mps2;
  return sample;
}

}  // namespace

EskfFilter::EskfFilter(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu,
                       const Geodetic& anchor, Counters& counters)
    : params_(params),
      lever_arm_imu_(lever_arm_imu),
      earth_(anchor),
      start_(params, lever_arm_imu, earth_),
      counters_(counters) {}

void EskfFilter::update(Stamp stamp, const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2) {
  if (stamp <= last_fix_) {
    fix_duplicate_.add(counters_);
    return;
  }
  last_fix_ = stamp;
  enqueue({stamp, MeasurementQueue::Fix{p_map_antenna, R_m2}});
}

void EskfFilter::updateHeading(Stamp stamp, double yaw_rad, double variance_rad2) {
  enqueue({stamp, MeasurementQueue::Heading{yaw_rad, variance_rad2}});
}

void EskfFilter::enqueue(const Entry& entry) {
  // The next sample is not older than this entry: if it is the first one, or follows a gap too long to
  // bridge, what waits is lost.
  const bool lost = !current_ || toSeconds(entry.stamp - current_->stamp) > kLongestGap_s;
  if (lost) skipPendingBefore(entry.stamp, &EskfFilter::fix_alone_, &EskfFilter::heading_alone_);
  if (pending_.full()) {
    skip(pending_.front(), &EskfFilter::fix_alone_, &EskfFilter::heading_alone_);
    pending_.pop();
  }
  pending_.push(entry);
}

void EskfFilter::skip(const Entry& entry, Tally EskfFilter::*fix_tally, Tally EskfFilter::*heading_tally) {
  if (entry.isHeight()) return height_alone_.add(counters_);
  (this->*(entry.isFix() ? fix_tally : heading_tally)).add(counters_);
}

void EskfFilter::skipPendingBefore(Stamp stamp, Tally EskfFilter::*fix_tally,
                                   Tally EskfFilter::*heading_tally) {
  while (!pending_.empty() && pending_.front().stamp < stamp) {
    skip(pending_.front(), fix_tally, heading_tally);
    pending_.pop();
  }
}

std::optional<Odometry> EskfFilter::propagate(const ImuSample& sample) {
  if (current_ && sample.stamp <= current_->stamp) {
    imu_late_.add(counters_);
    return std::nullopt;
  }
  const double dt = current_ ? toSeconds(sample.stamp - current_->stamp) : 0.0;
  double gap_s = 0.0;
  if (!current_ || dt > kLongestGap_s) {
    if (current_) restarts_.add(counters_);
    restart(sample);
  } else if (period_s_ > 0.0 && dt > kGapLeast_s && dt > kGapPeriods * period_s_) {
    gap_s = dt;
    monitor_.clear();
    still_blocks_ = 0;
    if (dt > params_.max_imu_gap_s) gaps_.add(counters_);
  } else {
    period_s_ += (period_s_ > 0.0 ? 0.05 : 1.0) * (dt - period_s_);
  }
  const Stamp before = current_->stamp;
  usePending(sample);
  stepTo(sample, gap_s);
  if (sample.orientation && !running_) start_.orientation(*sample.orientation);
  usePending(sample);  // those at this very stamp
  if (!running_) tryStart();
  if (const auto block = monitor_.add(sample)) {
    if (running_) constrain(*block, sample);
  }
  if (!running_) return std::nullopt;
  if (history_ != nullptr) history_->sample(sample.stamp, state_, rate());
  return odometry(std::max(toSeconds(sample.stamp - before), period_s_));
}

void EskfFilter::distrust(double velocity_variance, double turn_variance) {
  if (!running_) return;
  P_.diagonal().segment<3>(eskf::kV).array() += velocity_variance;
  P_.diagonal().segment<3>(eskf::kTheta).array() += turn_variance;
}

void EskfFilter::finish() {
  skipPendingBefore(kEndOfTime, &EskfFilter::fix_after_, &EskfFilter::heading_after_);
}

bool EskfFilter::record(eskf::History* history) {
  ATLAS_CHECK(!running_, "eskf: recording begins before the filter runs");
  history_ = history;
  return true;
}

void EskfFilter::restart(const ImuSample& first) {
  skipPendingBefore(first.stamp, &EskfFilter::fix_alone_, &EskfFilter::heading_alone_);
  start_ = eskf::Start(params_, lever_arm_imu_, earth_);
  running_ = yaw_checked_ = false;
  rejected_ = recoveries_ = still_blocks_ = 0;
  block_before_.reset();
  monitor_.clear();
  current_ = first;
  if (first.orientation) start_.orientation(*first.orientation);
}

void EskfFilter::usePending(const ImuSample& sample) {
  while (!pending_.empty() && pending_.front().stamp <= sample.stamp) {
    const Entry next = pending_.front();
    ATLAS_CHECK(next.stamp >= current_->stamp, "positioning: measurement older than the state");
    if (next.stamp == sample.stamp && current_->stamp != sample.stamp)
      return;  // after the step to the sample
    pending_.pop();
    if (next.stamp > current_->stamp) {
      const double dt = toSeconds(sample.stamp - current_->stamp);
      const bool gap = period_s_ > 0.0 && dt > kGapLeast_s && dt > kGapPeriods * period_s_;
      stepTo(interpolateAt(next.stamp, *current_, sample), gap ? dt : 0.0);
    }
    std::visit([&](const auto& measurement) { use(next.stamp, measurement); }, next.measurement);
    if (!running_) tryStart();
  }
}

void EskfFilter::stepTo(const ImuSample& sample, double gap_s) {
  const double dt = toSeconds(sample.stamp - current_->stamp);
  if (dt <= 0.0) return;
  if (!running_) {
    start_.move(sample.stamp, inertial(*current_), inertial(sample), dt);
    current_ = sample;
    return;
  }
  if (!yaw_checked_) start_.move(sample.stamp, inertial(*current_), inertial(sample), dt);
  const EskfParams& e = params_.eskf;
  const double accel =
      std::max(e.accelerometer_noise_mps2_sqrt_hz, e.vibration_share * monitor_.forceDensity());
  const double gyro = std::max(e.gyroscope_noise_radps_sqrt_hz, e.vibration_share * monitor_.gyroDensity());
  eskf::ProcessNoise noise;
  // White noise that adds up to the unknown motion over the whole gap.
  noise.accel_mps2_sqrt_hz = std::sqrt(accel * accel + gap_s * kGapAcceleration_mps2 * kGapAcceleration_mps2);
  noise.gyro_radps_sqrt_hz = std::sqrt(gyro * gyro + gap_s * kGapRate_radps * kGapRate_radps);
  noise.gyro_walk = e.gyroscope_bias_walk_radps2_sqrt_hz;
  noise.accel_walk = e.accelerometer_bias_walk_mps3_sqrt_hz;
  noise.heading_slow_rad = std::sqrt(params_.gnss_heading_slow_share) * params_.gnss_heading_sigma_rad;
  noise.heading_slow_time_s = params_.gnss_heading_slow_time_s;
  const eskf::Transition transition =
      eskf::move(state_, earth_, inertial(*current_), inertial(sample), dt, noise.heading_slow_time_s);
  eskf::moveCovariance(P_, transition, noise);
  if (history_ != nullptr) history_->moved(transition);
  current_ = sample;
}

void EskfFilter::tryStart() {
  const auto result = start_.result(inertial(*current_));
  if (!result) return;
  begin(*result);
  running_ = true;
  (result->from_velocity ? started_velocity_ : started_gnss_).add(counters_);
}

void EskfFilter::begin(const eskf::Start::Result& result) {
  state_ = result.state;
  P_ = result.P;
  if (state_.mounted_rad != 0.0) mounted_.add(counters_);
  last_used_fix_ = last_used_heading_ = current_->stamp;
  if (history_ != nullptr) history_->begin(current_->stamp, P_);
}

void EskfFilter::use(Stamp stamp, const MeasurementQueue::Fix& fix) {
  if (!running_) {
    start_.fix(fix.p_map_antenna, fix.R_m2);
    fix_used_.add(counters_);
    return;
  }
  if (!yaw_checked_) checkYaw(fix);
  const auto z = eskf::fixMeasurement(state_, rate(), fix.p_map_antenna, fix_scale_ * fix.R_m2);
  const bool accepted = apply<3>("fix", z, params_.gate_mahalanobis_sq);
  learnFixScale(stamp);
  if (accepted) {
    fix_used_.add(counters_);
    last_used_fix_ = stamp;
    slow_fix_m2_ = std::max(0.0, 1.0 - fix_scale_) * fix.R_m2;
    rejected_ = 0;
    if (last_mahalanobis_sq_ < 0.5 * params_.gate_mahalanobis_sq) recoveries_ = 0;
    return;
  }
  fix_outlier_.add(counters_);
  if (rejected_ == 0) rejecting_since_ = last_used_fix_;
  ++rejected_;
  if (rejected_ >= params_.max_consecutive_rejections &&
      toSeconds(stamp - rejecting_since_) > params_.eskf.recovery_s)
    recoverPosition(stamp, z.y);
}

void EskfFilter::use(Stamp stamp, const MeasurementQueue::Heading& heading) {
  if (!running_) {
    start_.heading(heading.yaw_rad, heading.variance);
    return;
  }
  const double white = (1.0 - params_.gnss_heading_slow_share) * heading.variance;
  if (apply<1>("heading", eskf::headingMeasurement(state_, heading.yaw_rad, white),
               params_.heading_gate_mahalanobis_sq)) {
    heading_used_.add(counters_);
    last_used_heading_ = stamp;
    return;
  }
  heading_outlier_.add(counters_);
  if (toSeconds(stamp - last_used_heading_) < 2.0 * params_.eskf.recovery_s) return;
  heading_recovered_.add(counters_);
  last_used_heading_ = stamp;
  P_(eskf::kTheta + 2, eskf::kTheta + 2) += kRecoveredYaw_rad * kRecoveredYaw_rad;
}

}  // namespace atlas
