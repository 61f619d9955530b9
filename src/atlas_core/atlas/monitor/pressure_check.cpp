// SPDX-License-Identifier: MIT
#include "atlas/monitor/pressure_check.hpp"

#include <cmath>

namespace atlas {

void PressureCheck::add(const ScalarSample& sample, Findings& findings) {
  const bool finite = std::isfinite(sample.value);
  findings.measure(Anomaly::kNotFinite, sample.stamp, finite ? 0.0 : 1.0);
  if (!finite) return;
  findings.measure(Anomaly::kPressureFrozen, sample.stamp, same_.add(sample.stamp, sample.value));
  const double step = before_pa_ ? std::abs(sample.value - *before_pa_) : 0.0;
  findings.measure(Anomaly::kPressureStep, sample.stamp, step);
  before_pa_ = sample.value;
}

}  // namespace atlas
