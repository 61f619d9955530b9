// SPDX-License-Identifier: MIT
// When fixes and state disagree: who is believed, and how the filter comes back.
#include <algorithm>
#include <cmath>

#include "atlas/localization/eskf_filter.hpp"

namespace atlas {
namespace {

constexpr double kRecoveredSpeed_mps = 3.0;  // standard deviations added in a recovery
constexpr int kMostRecoveries = 2;
constexpr double kMisfitMemory_s = 1.0, kMisfitGain_per_s = 0.5;  // doubt in fixes grows over seconds
constexpr double kUsualMisfit = 1.5, kMostMisfit = 4.0;           // of mahalanobis_sq / 3, whose mean is 1
constexpr double kMostFixScale = 1e4;
constexpr double kHumbleFixes = 30.0;  // so many fixes show that they are better than they say
constexpr double kHumbleMisfit = 0.3, kJustMisfit = 0.6;  // below: noise is smaller; above: it is not
constexpr double kShrink_per_s = 1.0, kRegret = 6.0;      // doubt returns faster than trust
constexpr double kLeastFixScale = 0.02;
constexpr double kMostYawError_rad = 0.5;  // a filter that is further off does not come back by itself

}  // namespace

void EskfFilter::checkYaw(const MeasurementQueue::Fix& fix) {
  // A heading from the course takes the imu to look forward and the car to drive forward.
  start_.fix(fix.p_map_antenna, fix.R_m2);
  const auto yaw = start_.seenYaw();
  if (!yaw) return;
  const Eigen::Vector3d x = state_.R * Eigen::Vector3d::UnitX();
  if (std::abs(wrapAngle(*yaw - std::atan2(x.y(), x.x()))) < kMostYawError_rad) {
    yaw_checked_ = true;
    return;
  }
  const auto result = start_.result({current_->angular_velocity_radps, current_->linear_acceleration_mps2});
  if (!result) return;  // in too tight a turn, for instance: at the next fix
  begin(*result);
  yaw_checked_ = true;
  turned_.add(counters_);
}

void EskfFilter::learnFixScale(Stamp stamp) {
  // Fixes that fit worse than they say for a while are worse: multipath, a wrong lever arm, late stamps.
  const double dt = std::min(toSeconds(stamp - last_scaled_fix_), 1.0);
  last_scaled_fix_ = stamp;
  fix_misfit_ +=
      std::min(1.0, dt / kMisfitMemory_s) * (std::min(last_mahalanobis_sq_ / 3.0, kMostMisfit) - fix_misfit_);
  double gain = kMisfitGain_per_s * (fix_misfit_ - kUsualMisfit);
  if (fix_scale_ < 1.0 && gain > 0.0) gain *= kRegret;
  // Fixes that agree with the motion far better than they say err slowly: white noise of their stated size
  // would waste what they tell about velocity and tilt (innovation-based adaptation, Mehra 1972). The slow
  // part stays in the covariance that is reported.
  mean_misfit_ += (std::min(last_mahalanobis_sq_ / 3.0, kMostMisfit) - mean_misfit_) / kHumbleFixes;
  double least = std::min(fix_scale_, 1.0), most = std::max(fix_scale_, 1.0);
  if (gain > 0.0) most = kMostFixScale;
  if (fix_scale_ <= 1.0 && mean_misfit_ < kHumbleMisfit) {
    gain = -kShrink_per_s;
    least = kLeastFixScale;
  } else if (fix_scale_ < 1.0 && gain <= 0.0) {
    gain = kShrink_per_s * std::max(0.0, mean_misfit_ - kJustMisfit);
  } else if (fix_scale_ > 1.0) {
    least = 1.0;
  }
  fix_scale_ = std::clamp(fix_scale_ * std::exp(gain * dt), least, most);
}

void EskfFilter::recoverPosition(Stamp stamp, const Eigen::Vector3d& innovation_m) {
  rejected_ = 0;
  last_used_fix_ = stamp;
  if (++recoveries_ > kMostRecoveries) {
    started_anew_.add(counters_);
    const ImuSample now = *current_;
    restart(now);
    return;
  }
  recovered_.add(counters_);
  if (yaw_checked_) start_ = eskf::Start(params_, lever_arm_imu_, earth_);
  yaw_checked_ = false;  // maybe it is the heading that is wrong
  for (int i = 0; i < 3; ++i) {
    P_(eskf::kP + i, eskf::kP + i) += innovation_m.squaredNorm();
    P_(eskf::kV + i, eskf::kV + i) += kRecoveredSpeed_mps * kRecoveredSpeed_mps;
  }
}

}  // namespace atlas
