// SPDX-License-Identifier: MIT
#include "atlas/calibration/rig.hpp"

namespace atlas {
namespace {
bool isBase(const std::string& frame) { return frame == "base_link" || frame == "imu"; }
std::string withoutSlash(const std::string& frame) {
  return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame;
}
}  // namespace

void Rig::add(const StaticTransforms& transforms) {
  for (const StaticTransform& t : transforms.transforms) {
    StaticTransform clean = t;
    clean.parent = withoutSlash(t.parent);
    clean.child = withoutSlash(t.child);
    parent_of_[clean.child] = clean;
  }
}

Outcome<Pose> Rig::T_imu(const std::string& frame) const {
  std::string current = withoutSlash(frame);
  Pose T_current_frame;
  for (std::size_t steps = 0; steps <= parent_of_.size(); ++steps) {  // a loop in the tree ends here
    if (isBase(current)) return T_current_frame;
    const auto it = parent_of_.find(current);
    if (it == parent_of_.end()) return Reason::kMissingFrame;
    T_current_frame = it->second.T_parent_child * T_current_frame;
    current = it->second.parent;
  }
  return Reason::kMissingFrame;
}

}  // namespace atlas
