// SPDX-License-Identifier: MIT
#include "atlas/monitor/clock_check.hpp"

#include <algorithm>
#include <cstdlib>

namespace atlas {
namespace {
constexpr double kMillisecondsPerSecond = 1e3;
double milliseconds(Duration duration) { return kMillisecondsPerSecond * toSeconds(std::abs(duration)); }
}  // namespace

void ClockCheck::add(const TimeReference& reference, Findings& findings) {
  const Duration delay = reference.stamp - reference.sensor_time;
  const Duration step = before_ ? delay - *before_ : 0;
  findings.measure(Anomaly::kClockJump, reference.stamp, milliseconds(step));
  before_ = delay;
  if (window_begin_ == kBeginOfTime) {
    window_begin_ = reference.stamp;
    smallest_ = delay;
  }
  smallest_ = std::min(smallest_, delay);
  if (reference.stamp - window_begin_ < kSecond) return;
  if (!baseline_) baseline_ = smallest_;
  findings.measure(Anomaly::kClockDrift, reference.stamp, milliseconds(smallest_ - *baseline_));
  window_begin_ = reference.stamp;
  smallest_ = delay;
}

}  // namespace atlas
