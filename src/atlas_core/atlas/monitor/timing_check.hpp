// SPDX-License-Identifier: MIT
// What the stamps of one stream say: missing, gap, duplicate, misordered, rate. The usual period is the
// median of the first intervals.
#pragma once

#include <vector>

#include "atlas/monitor/findings.hpp"

namespace atlas {

class TimingCheck {
 public:
  /// A message in order of stamps.
  void add(Stamp stamp, Findings& findings);
  /// Messages that came with a stamp before their predecessor's; `stamp` is that of the next one in order.
  void misordered(Stamp stamp, std::uint64_t messages, Findings& findings) const;
  /// Time has come to `now` (a clock of the monitor). `begin`: since when the sensor is waited for.
  void tick(Stamp now, Stamp begin, Findings& findings) const;

  [[nodiscard]] bool seen() const { return last_ != kBeginOfTime; }
  /// 0 before it is known.
  [[nodiscard]] Duration period() const { return period_; }

 private:
  void learn(Duration interval);
  void measureRate(Stamp stamp, Findings& findings);

  Stamp last_ = kBeginOfTime;
  std::vector<Duration> first_intervals_;
  Duration period_ = 0;
  Stamp window_begin_ = kBeginOfTime;
  int in_window_ = 0;
};

}  // namespace atlas
