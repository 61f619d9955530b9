// SPDX-License-Identifier: MIT
#include "atlas/base/trajectory.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace atlas {

void Trajectory::push(const StampedPose& pose) {
  if (!poses_.empty() && pose.stamp <= poses_.back().stamp) {
    throw std::invalid_argument("trajectory: stamp " + std::to_string(pose.stamp) + " is not after " +
                                std::to_string(poses_.back().stamp));
  }
  poses_.push_back(pose);
}

void Trajectory::forgetBefore(Stamp stamp) {
  while (poses_.size() >= 2 && poses_[1].stamp <= stamp) poses_.pop_front();
}

Outcome<Pose> Trajectory::at(Stamp stamp) const {
  if (poses_.empty() || stamp < poses_.front().stamp) return Reason::kNoPoseYet;
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), stamp,
                                      [](const StampedPose& p, Stamp s) { return p.stamp < s; });
  if (after == poses_.end()) return Reason::kPoseNotReached;
  if (after->stamp == stamp) return after->pose;
  const StampedPose& before = *(after - 1);
  const Duration span = after->stamp - before.stamp;
  if (span > max_gap_) return Reason::kPoseGap;
  return interpolate(before.pose, after->pose,
                     static_cast<double>(stamp - before.stamp) / static_cast<double>(span));
}

}  // namespace atlas
