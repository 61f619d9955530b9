// SPDX-License-Identifier: MIT
// The stamps of a sensor against its own clock: steps, and slow drift of the smallest delay.
#pragma once

#include <optional>

#include "atlas/monitor/findings.hpp"

namespace atlas {

class ClockCheck {
 public:
  void add(const TimeReference& reference, Findings& findings);

 private:
  std::optional<Duration> before_;    ///< delay of the previous message
  std::optional<Duration> baseline_;  ///< smallest delay of the first second
  Stamp window_begin_ = kBeginOfTime;
  Duration smallest_ = 0;
};

}  // namespace atlas
