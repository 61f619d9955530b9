// SPDX-License-Identifier: MIT
// The scans of a radar: numbers that are none, frozen targets.
#pragma once

#include <vector>

#include "atlas/monitor/findings.hpp"
#include "atlas/monitor/same_for.hpp"

namespace atlas {

class RadarCheck {
 public:
  void add(const RadarScan& scan, Findings& findings);

 private:
  SameFor<std::vector<double>> same_;  ///< coordinates and velocities
};

}  // namespace atlas
