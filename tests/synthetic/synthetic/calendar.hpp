// SPDX-License-Identifier: MIT
// UTC calendar of a stamp, for the time.txt files.
#pragma once

#include <cstdint>

#include "atlas/base/time.hpp"

namespace atlas::synthetic {

struct CalendarTime {
  int year, month, day, hour, minute, second;
  std::int64_t nanosecond;
};

/// The stamp rounded to `resolution_ns`. Days to date after Hinnant 2013, "chrono-Compatible Low-Level Date
/// Algorithms".
inline CalendarTime calendarTime(Stamp stamp, std::int64_t resolution_ns) {
  const std::int64_t rounded = (stamp + resolution_ns / 2) / resolution_ns * resolution_ns;
  const std::int64_t seconds = rounded / kSecond, of_day = seconds % 86400;
  const std::int64_t days = seconds / 86400 + 719468, era = days / 146097, of_era = days - era * 146097;
  const std::int64_t year = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
  const std::int64_t of_year = of_era - (365 * year + year / 4 - year / 100),
                     shifted = (5 * of_year + 2) / 153;
  const int month = static_cast<int>(shifted < 10 ? shifted + 3 : shifted - 9);
  return {static_cast<int>(year + era * 400 + (month <= 2 ? 1 : 0)),
          month,
          static_cast<int>(of_year - (153 * shifted + 2) / 5 + 1),
          static_cast<int>(of_day / 3600),
          static_cast<int>(of_day / 60 % 60),
          static_cast<int>(of_day % 60),
          rounded % kSecond};
}

}  // namespace atlas::synthetic
