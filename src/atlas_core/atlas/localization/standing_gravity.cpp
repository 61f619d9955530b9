// SPDX-License-Identifier: MIT
#include "atlas/localization/standing_gravity.hpp"

#include <cmath>

namespace atlas {
namespace {
constexpr double kMaxSpeed_mps = 0.3;    // above the noise of a velocity made of centimetre fixes
constexpr double kMaxRate_radps = 0.05;  // 3 deg/s: above gyroscope bias, below any turn
constexpr double kMaxExcess_mps2 = 0.5;  // engine vibration passes, shocks do not
constexpr Duration kSpan = kSecond / 2;
}  // namespace

std::optional<StandingGravity::Up> StandingGravity::add(const ImuSample& sample,
                                                        std::optional<double> speed_mps,
                                                        double gravity_mps2) {
  const Eigen::Vector3d& a = sample.linear_acceleration_mps2;
  const bool standing = speed_mps && *speed_mps < kMaxSpeed_mps &&
                        sample.angular_velocity_radps.norm() < kMaxRate_radps &&
                        std::abs(a.norm() - gravity_mps2) < kMaxExcess_mps2;
  if (!standing) {
    clear();
    return std::nullopt;
  }
  if (count_ == 0) {
    first_ = sample.stamp;
    sum_.setZero();
  }
  ++count_;
  sum_ += a;
  if (sample.stamp - first_ < kSpan) return std::nullopt;
  const Up mean{sum_.normalized(), toSeconds(sample.stamp - first_)};
  count_ = 0;
  ++blocks_;
  if (blocks_ == 1) return std::nullopt;  // maybe still braking
  const std::optional<Up> confirmed = blocks_ > 2 ? held_ : std::nullopt;
  held_ = mean;
  return confirmed;
}

}  // namespace atlas
