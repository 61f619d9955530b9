// SPDX-License-Identifier: MIT
// The barometer: frozen, steps.
#pragma once

#include "atlas/monitor/findings.hpp"
#include "atlas/monitor/same_for.hpp"

namespace atlas {

class PressureCheck {
 public:
  void add(const ScalarSample& sample, Findings& findings);

 private:
  SameFor<double> same_;
  std::optional<double> before_pa_;
};

}  // namespace atlas
