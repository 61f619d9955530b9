// SPDX-License-Identifier: MIT
// The odometry a stage keeps, and the answer to "is the pose at this stamp known, unknown for good, or still
// to come?". The answer depends on the data only, not on the order in which the inputs arrived.
#pragma once

#include <cmath>
#include <optional>

#include "atlas/base/counters.hpp"
#include "atlas/base/trajectory.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

class PoseHistory {
 public:
  explicit PoseHistory(double max_gap_s) : max_gap_(fromSeconds(max_gap_s)), trajectory_(max_gap_) {}

  /// Adds a pose; one that is not finite, not normalized or not after the last one is counted and not used.
  void push(const Odometry& odometry, Counters& counters) {
    const Pose& pose = odometry.T_map_imu;
    if (!pose.translation.allFinite() || !pose.rotation.coeffs().allFinite()) {
      counters.skip("odometry", Reason::kNotFinite);
    } else if (std::abs(pose.rotation.squaredNorm() - 1.0) > 1e-3) {
      counters.skip("odometry", Reason::kNotNormalized);
    } else if (!trajectory_.empty() && odometry.stamp <= trajectory_.poses().back().stamp) {
      counters.skip("odometry", Reason::kOutOfOrder);
    } else {
      trajectory_.push({odometry.stamp, pose});
    }
  }

  /// T_map_imu at `stamp`, or why it never will be known; nullopt while a pose that is near enough may still
  /// come. `merged`: every input at or before this has been seen. A pose that is not there when it passes
  /// stamp + max_gap would come too late to interpolate, so that case is a gap, too.
  [[nodiscard]] std::optional<Outcome<Pose>> at(Stamp stamp, Stamp merged) const {
    const Outcome<Pose> pose = trajectory_.at(stamp);
    if (pose) return pose;
    if (pose.reason() == Reason::kPoseGap) return pose;
    const bool none_before = trajectory_.empty() || stamp < trajectory_.poses().front().stamp;
    if (none_before && merged >= stamp) return Outcome<Pose>(Reason::kNoPoseYet);
    if (!none_before && merged >= stamp + max_gap_) return Outcome<Pose>(Reason::kPoseGap);
    return std::nullopt;
  }

  /// Poses that no question at or after `stamp` needs are dropped.
  void forgetBefore(Stamp stamp) { trajectory_.forgetBefore(stamp); }

 private:
  Duration max_gap_;
  Trajectory trajectory_;
};

}  // namespace atlas
