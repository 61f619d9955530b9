// SPDX-License-Identifier: MIT
#include "atlas/localization/imu_guard.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace atlas {
namespace {

constexpr double kLeastForceRange_mps2 = 18.6, kLeastRateRange_radps = 1.7;  // a bit below 2 g and 100 deg/s
constexpr double kMostForce_mps2 = 200.0, kMostRate_radps = 40.0;
constexpr double kNearRange = 0.9999;  // values are recorded with five digits or more
constexpr int kRepeatsAtRange = 3;
constexpr double kUnseenAcceleration_mps2 = 1.5, kUnseenRate_radps = 0.2;  // what a vehicle may do unseen
constexpr int kLeastVaried = 100, kLeastSame = 10;
constexpr double kGapPeriods = 5.0, kGapLeast_s = 0.02;
constexpr double kPeriodGain = 0.05;
constexpr Duration kWindow = 2 * kSecond;
constexpr int kLeastSamples = 50;           // in a window that is judged
constexpr double kFastestTurn_radps = 5.0;  // mean over a window; no road vehicle
constexpr double kTurnsToCompare_rad = 3.0;
constexpr double kRatioOfDegrees = 10.0;  // they are 57 times as large

double largestOf(const Eigen::Vector3d& v) { return v.cwiseAbs().maxCoeff(); }

[[noreturn]] void refuse(const char* quantity, double value, const char* verdict) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "imu/data: " << quantity << " " << value << ": " << verdict;
  throw std::runtime_error(text.str());
}

}  // namespace

void validate(const ImuGuardParams& p) {
  const std::pair<const char*, double> all[] = {{"accelerometer_range_mps2", p.accelerometer_range_mps2},
                                                {"gyroscope_range_radps", p.gyroscope_range_radps},
                                                {"imu_frozen_after_s", p.frozen_after_s}};
  for (const auto& [field, value] : all) {
    if (value >= 0.0 && std::isfinite(value)) continue;
    throw std::invalid_argument("localization: need " + std::string(field) + " >= 0, got " +
                                std::to_string(value));
  }
}

ImuGuard::ImuGuard(const ImuGuardParams& params, Counters& counters) : params_(params), counters_(counters) {
  accel_.range = params.accelerometer_range_mps2;
  accel_.least = kLeastForceRange_mps2;
  gyro_.range = params.gyroscope_range_radps;
  gyro_.least = kLeastRateRange_radps;
}

bool ImuGuard::usable(const ImuSample& sample) {
  doubt_ = {};
  verdict_ = {};
  if (before_ && sample.stamp <= before_->stamp) return true;  // the filter counts it
  if (largestOf(sample.linear_acceleration_mps2) > kMostForce_mps2) {
    counters_.add("skipped imu: acceleration beyond 200 m/s^2");
    verdict_.beyond = true;
    return false;
  }
  watchUnits(sample);
  if (largestOf(sample.angular_velocity_radps) > kMostRate_radps) {
    counters_.add("skipped imu: turn rate beyond 40 rad/s");
    verdict_.beyond = true;
    return false;
  }
  watchGap(sample);
  const ImuSample before = before_.value_or(sample);
  const bool was_frozen = is_frozen_;
  is_frozen_ = before_ && frozen(sample);
  verdict_.frozen = is_frozen_;
  bool usable = !is_frozen_;
  // A signal that stands still altogether is frozen, not saturated.
  if (same_ == 0 && before_) judgeRange(sample, before, usable);
  before_ = sample;
  if (is_frozen_) counters_.add("skipped imu: frozen, the same values again and again");
  if (is_frozen_ && !was_frozen) {  // those before were used
    const double span_s = toSeconds(sample.stamp - same_since_);
    doubt_ = {std::pow(kUnseenAcceleration_mps2 * span_s, 2), std::pow(kUnseenRate_radps * span_s, 2)};
  }
  return usable;
}

void ImuGuard::judgeRange(const ImuSample& sample, const ImuSample& before, bool& usable) {
  if (accel_.saturated(sample.linear_acceleration_mps2, before.linear_acceleration_mps2)) {
    counters_.add("skipped imu: accelerometer saturated");
    verdict_.accelerometer_saturated = true;
    doubt_.velocity = accel_.doubt(period_s_);
    usable = false;
  }
  if (gyro_.saturated(sample.angular_velocity_radps, before.angular_velocity_radps)) {
    counters_.add("skipped imu: gyroscope saturated");
    verdict_.gyroscope_saturated = true;
    doubt_.turn = gyro_.doubt(period_s_);
    usable = false;
  }
}

bool ImuGuard::Group::saturated(const Eigen::Vector3d& now, const Eigen::Vector3d& before) {
  for (int i = 0; i < 3; ++i) repeats[i] = now(i) == before(i) ? repeats[i] + 1 : 1;
  const double size = largestOf(now);
  if (learned && size > range / kNearRange) range = 0.0;  // a larger value: it was no limit
  if (range > 0.0) {
    clipped = size >= kNearRange * range ? clipped + 1 : 0;
    return clipped > 0;
  }
  largest = std::max(largest, size);
  for (int i = 0; i < 3; ++i) {
    const bool extreme = std::abs(now(i)) >= least && std::abs(now(i)) >= largest;
    if (extreme && repeats[i] >= kRepeatsAtRange) range = std::abs(now(i));
  }
  learned = range > 0.0;
  clipped = learned ? kRepeatsAtRange : 0;
  return learned;
}

void ImuGuard::watchGap(const ImuSample& sample) {
  if (!before_) return;
  const double dt = toSeconds(sample.stamp - before_->stamp);
  if (period_s_ > 0.0 && dt > kGapLeast_s && dt > kGapPeriods * period_s_) {
    counters_.add("imu gaps");
    counters_.add("imu gaps, ms altogether", static_cast<std::uint64_t>(std::llround(1e3 * dt)));
    window_.reset();
    return;
  }
  period_s_ += (period_s_ > 0.0 ? kPeriodGain : 1.0) * (dt - period_s_);
}

bool ImuGuard::frozen(const ImuSample& sample) {
  const bool same = sample.angular_velocity_radps == before_->angular_velocity_radps &&
                    sample.linear_acceleration_mps2 == before_->linear_acceleration_mps2;
  if (!same) {
    varied_ = std::min(varied_ + 1, kLeastVaried);
    same_ = 0;
    return false;
  }
  if (same_++ == 0) same_since_ = before_->stamp;
  return params_.frozen_after_s > 0.0 && varied_ >= kLeastVaried && same_ >= kLeastSame &&
         toSeconds(sample.stamp - same_since_) >= params_.frozen_after_s;
}

void ImuGuard::watchUnits(const ImuSample& sample) {
  if (!window_) window_.emplace().begin = sample.stamp;
  Window& w = *window_;
  if (before_ && w.samples > 0) {
    const double dt = toSeconds(sample.stamp - before_->stamp);
    w.turned_rad += dt * sample.angular_velocity_radps;
    w.turning_rad += dt * sample.angular_velocity_radps.norm();
    if (sample.orientation && before_->orientation)
      w.own_turning_rad += sample.orientation->angularDistance(*before_->orientation);
  }
  w.force_sum += sample.linear_acceleration_mps2;
  ++w.samples;
  const Duration span = sample.stamp - w.begin;
  if (span < kWindow) return;
  if (w.samples >= kLeastSamples) judgeUnits(toSeconds(span));
  window_.reset();
}

void ImuGuard::judgeUnits(double span_s) {
  const Window& w = *window_;
  const double rate = w.turning_rad / span_s;
  if (rate > kFastestTurn_radps)
    refuse("mean turn rate", rate, "no vehicle turns so fast; in degrees? rad/s is needed");
  if (w.own_turning_rad > 0.0 && w.turned_rad.norm() > kTurnsToCompare_rad &&
      w.turned_rad.norm() > kRatioOfDegrees * w.own_turning_rad)
    refuse("mean turn rate", w.turned_rad.norm() / span_s,
           "many times that of the IMU's own orientation; in degrees? rad/s is needed");
  if (force_judged_) return;
  force_judged_ = true;
  const Eigen::Vector3d force = w.force_sum / w.samples;
  if (force.norm() > 0.5 && force.norm() < 1.5)
    refuse("mean acceleration", force.norm(), "in g; m/s^2 is needed (9.8 at rest)");
  if (force.norm() < 7.0 || force.norm() > 13.0)
    refuse("mean acceleration", force.norm(), "not gravity; 9.8 m/s^2 upwards are needed at rest (REP-145)");
  if (force.z() < -7.0)
    refuse("mean acceleration in z", force.z(), "gravity must point up at rest (forward-left-up axes)");
}

}  // namespace atlas
