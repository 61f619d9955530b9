// SPDX-License-Identifier: MIT
// Poses over time: what a stage keeps of the odometry to answer "where was the vehicle at this stamp?".
#pragma once

#include <deque>

#include "atlas/base/geometry.hpp"
#include "atlas/base/outcome.hpp"
#include "atlas/base/time.hpp"

namespace atlas {

struct StampedPose {
  Stamp stamp = 0;
  Pose pose;  ///< T_map_imu
};

class Trajectory {
 public:
  /// Poses farther apart than max_gap are not interpolated.
  explicit Trajectory(Duration max_gap = kSecond / 2) : max_gap_(max_gap) {}

  /// Appends; a stamp not after the last one throws std::invalid_argument.
  void push(const StampedPose& pose);
  /// Drops poses that no query at or after `stamp` needs (the last one at or before it stays).
  void forgetBefore(Stamp stamp);
  void clear() { poses_.clear(); }

  /// T_map_imu at `stamp`: slerp and linear between the two neighbours, exact at a stored stamp. No
  /// extrapolation: kNoPoseYet, kPoseNotReached or kPoseGap otherwise.
  [[nodiscard]] Outcome<Pose> at(Stamp stamp) const;

  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] const std::deque<StampedPose>& poses() const { return poses_; }

 private:
  Duration max_gap_;
  std::deque<StampedPose> poses_;
};

}  // namespace atlas
