// SPDX-License-Identifier: MIT
// The magnetometer: frozen, and a norm that steps away from its usual value (steel, motors, currents nearby).
#pragma once

#include "atlas/monitor/findings.hpp"
#include "atlas/monitor/same_for.hpp"

namespace atlas {

class MagneticCheck {
 public:
  void add(const MagneticSample& sample, Findings& findings);

 private:
  SameFor<Eigen::Vector3d> same_;
  Stamp begin_ = kBeginOfTime;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  int count_ = 0;
  double usual_norm_ = 0.0;
};

}  // namespace atlas
