// SPDX-License-Identifier: MIT
// Event time. Every quantity that says "when" is a Stamp; seconds exist only at the edges (files, formulas).
#pragma once

#include <cstdint>
#include <limits>

namespace atlas {

/// Nanoseconds since the Unix epoch (UTC), the data's own time. Never a wall clock.
using Stamp = std::int64_t;
/// A signed difference of two stamps, nanoseconds.
using Duration = std::int64_t;

constexpr Stamp kBeginOfTime = std::numeric_limits<Stamp>::min();
constexpr Stamp kEndOfTime = std::numeric_limits<Stamp>::max();
constexpr Duration kSecond = 1'000'000'000;
constexpr Duration kMillisecond = 1'000'000;

/// Seconds of a duration; exact to 1 ns below 104 days.
constexpr double toSeconds(Duration duration_ns) { return static_cast<double>(duration_ns) * 1e-9; }
/// The nearest whole nanosecond.
constexpr Duration fromSeconds(double seconds) {
  return static_cast<Duration>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5));
}

}  // namespace atlas
