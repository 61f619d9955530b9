// SPDX-License-Identifier: MIT
#include "atlas/monitor/gnss_check.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/base/geometry.hpp"

namespace atlas {
namespace {
constexpr Duration kMotionSpan = kSecond, kLongestStep = 2 * kSecond;
constexpr double kMostAcceleration_mps2 = 6.0;  // hard braking
constexpr double kMostTurn_radps = 1.5;
constexpr double kSigmas = 4.0 * M_SQRT2;  // four of a difference of two fixes

double horizontalSigma(const GnssFix& fix) {
  if (!fix.covariance_enu_m2) return 0.0;
  const double larger = std::max((*fix.covariance_enu_m2)[0], (*fix.covariance_enu_m2)[4]);
  return larger > 0.0 ? std::sqrt(larger) : 0.0;
}
}  // namespace

void GnssCheck::add(const GnssFix& fix, Findings& findings) {
  const Geodetic& g = fix.position;
  const bool finite =
      std::isfinite(g.latitude_deg) && std::isfinite(g.longitude_deg) && std::isfinite(g.altitude_m);
  const bool none = g.latitude_deg == 0.0 && g.longitude_deg == 0.0;
  findings.measure(Anomaly::kNotFinite, fix.stamp, finite ? 0.0 : 1.0);
  findings.measure(Anomaly::kNoPosition, fix.stamp, none ? 1.0 : 0.0);
  if (heading_) findings.measure(Anomaly::kHeadingLost, fix.stamp, toSeconds(fix.stamp - heading_->stamp));
  if (!finite || none || std::abs(g.latitude_deg) > 90.0) return;
  findings.measure(Anomaly::kPositionSigma, fix.stamp, horizontalSigma(fix));
  findings.measure(Anomaly::kFixFrozen, fix.stamp,
                   same_.add(fix.stamp, {g.latitude_deg, g.longitude_deg, g.altitude_m}));
  if (!map_) map_.emplace(g);
  measureJump(fix, findings);
}

/// Against the motion over the last second: constant velocity, and what braking and noise may do to it.
void GnssCheck::measureJump(const GnssFix& fix, Findings& findings) {
  const Eigen::Vector3d p_map = map_->toMap(fix.position);
  // The receiver is slower than its stream, holds its position or is frozen: nothing is learned.
  if (!places_.empty() && places_.back().p_map == p_map) return;
  if (!places_.empty() && fix.stamp - places_.back().stamp > kLongestStep) places_.clear();
  if (!places_.empty()) {
    const Place &first = places_.front(), &last = places_.back();
    const double span_s = toSeconds(last.stamp - first.stamp), dt_s = toSeconds(fix.stamp - last.stamp);
    Eigen::Vector2d v_mps = Eigen::Vector2d::Zero();
    if (span_s > 0.0) v_mps = (last.p_map - first.p_map).head<2>() / span_s;
    const double reach_s = dt_s + 0.5 * span_s;  // the velocity is that of the middle of the span
    const Eigen::Vector2d predicted = last.p_map.head<2>() + dt_s * v_mps;
    const double unknown_m = span_s > 0.0 ? 0.0 : 60.0 * dt_s;  // no velocity yet: that of a car
    const double excused_m =
        kSigmas * horizontalSigma(fix) + kMostAcceleration_mps2 * dt_s * reach_s + unknown_m;
    const double off_m = (p_map.head<2>() - predicted).norm();
    findings.measure(Anomaly::kPositionJump, fix.stamp, std::max(0.0, off_m - excused_m));
    if (off_m - excused_m > findings.threshold(Anomaly::kPositionJump)) places_.clear();
  }
  places_.push_back({fix.stamp, p_map});
  while (places_.size() > 2 && places_[1].stamp <= fix.stamp - kMotionSpan) places_.pop_front();
  motion_.add(fix.stamp, p_map);
}

void GnssCheck::add(const GnssHeading& heading, Findings& findings) {
  const bool finite = std::isfinite(heading.yaw_rad);
  findings.measure(Anomaly::kNotFinite, heading.stamp, finite ? 0.0 : 1.0);
  if (!finite) return;
  findings.measure(Anomaly::kHeadingLost, heading.stamp, 0.0);
  if (heading_) {
    const double step = std::abs(wrapAngle(heading.yaw_rad - heading_->yaw_rad));
    const double turn = kMostTurn_radps * toSeconds(heading.stamp - heading_->stamp);
    findings.measure(Anomaly::kHeadingJump, heading.stamp, std::max(0.0, step - turn));
  }
  heading_ = heading;
}

}  // namespace atlas
