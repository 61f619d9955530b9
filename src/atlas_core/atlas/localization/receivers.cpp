// SPDX-License-Identifier: MIT
#include "atlas/localization/receivers.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace atlas {
namespace {

constexpr double kStale_s = 1.0;     // an older answer of the filter, or fix, is not compared with
constexpr double kJumpGate = 30.0;   // chi-square, 2 dof: p = 3e-7
constexpr double kAgreeGate = 13.8;  // 2 dof: p = 1e-3
constexpr double kApart = 5.0;       // standard deviations between the receivers
constexpr Duration kSecondPeriod = kSecond;

void requirePositive(const char* field, double value) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw std::invalid_argument("localization: need " + std::string(field) + " > 0, got " +
                              std::to_string(value));
}

}  // namespace

void validate(const ReceiverParams& p) {
  requirePositive("fallback_after_s", p.fallback_after_s);
  requirePositive("second_gnss_horizontal_sigma_m", p.second_gnss_horizontal_sigma_m);
  requirePositive("second_gnss_vertical_sigma_m", p.second_gnss_vertical_sigma_m);
  requirePositive("second_gnss_error_time_s", p.second_gnss_error_time_s);
}

const char* toString(Receivers::Use use) {
  switch (use) {
    case Receivers::Use::kPrimary:
      return "gnss/fix";
    case Receivers::Use::kSecondary:
      return "imu/gnss/fix";
    case Receivers::Use::kNone:
      break;
  }
  return "";
}

void Receivers::begin(Stamp stamp) {
  if (begin_ == kBeginOfTime) begin_ = stamp;
}

void Receivers::taken(Stamp stamp, Use receiver) {
  if (receiver == Use::kPrimary) first_taken_ = std::max(first_taken_, stamp);
  if (receiver == in_use_) return;
  if (receiver == Use::kSecondary) counters_.add("receiver: fell back to imu/gnss/fix");
  if (receiver == Use::kPrimary && in_use_ == Use::kSecondary)
    counters_.add("receiver: returned to gnss/fix");
  in_use_ = receiver;
}

std::optional<Receivers::Misfit> Receivers::misfit(const Fix& fix) const {
  if (starting(fix.stamp)) return std::nullopt;
  const double dt = toSeconds(fix.stamp - odometry_->stamp);
  const Pose& T = odometry_->T_map_imu;
  const Eigen::Vector3d p = fix.p_map_antenna - T.rotation * fix.lever_arm_imu;
  const Eigen::Vector3d ahead = T.translation + dt * (T.rotation * odometry_->velocity_imu_mps);
  const Eigen::Matrix2d P =
      Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(odometry_->pose_covariance.data())
          .topLeftCorner<2, 2>();
  const Eigen::Matrix2d S = P + fix.R_m2.topLeftCorner<2, 2>();
  const Eigen::Vector2d y = (p - ahead).head<2>();
  return Misfit{y.dot(S.inverse() * y), y};
}

bool Receivers::jumped(const Fix& first) {
  if (!second_ || std::abs(toSeconds(first.stamp - second_->stamp)) > kStale_s) return false;
  const auto now = misfit(first);
  if (!now || now->mahalanobis_sq < kJumpGate) return false;
  if (second_->misfit.mahalanobis_sq > kAgreeGate) return false;
  const double variance = second_->variance_m2 + 0.5 * first.R_m2.topLeftCorner<2, 2>().trace();
  // Both seen from the prediction at their own time: the vehicle's motion in between drops out.
  return (now->offset_m - second_->misfit.offset_m).squaredNorm() > kApart * kApart * variance;
}

bool Receivers::starting(Stamp now) const {
  return !odometry_ || toSeconds(now - odometry_->stamp) > kStale_s;
}

bool Receivers::firstIsSilent(Stamp now) const {
  const Stamp since = first_taken_ != kBeginOfTime ? first_taken_ : begin_;
  return since != kBeginOfTime && toSeconds(now - since) > params_.fallback_after_s;
}

std::optional<Receivers::Fix> Receivers::second(const Fix& fix) {
  const double variance = 0.5 * fix.R_m2.topLeftCorner<2, 2>().trace();
  if (const auto now = misfit(fix)) {
    second_ = Second{fix.stamp, variance, *now};
    if (now->mahalanobis_sq > kJumpGate) counters_.add("second fix: contradicts the position");
  }
  if (!firstIsSilent(fix.stamp)) {
    counters_.add("skipped second fix: the first receiver is in use");
    return std::nullopt;
  }
  Fix result = fix;
  if (second_given_ != kBeginOfTime) {
    const Duration dt = fix.stamp - second_given_;
    if (dt < kSecondPeriod) {
      counters_.add("skipped second fix: sooner than a second after the one before");
      return std::nullopt;
    }
    // A filter that starts wants the velocity, which slow errors leave alone.
    if (!starting(fix.stamp))
      result.R_m2 *= std::max(1.0, 2.0 * params_.second_gnss_error_time_s / toSeconds(dt));
  }
  second_given_ = fix.stamp;
  return result;
}

}  // namespace atlas
