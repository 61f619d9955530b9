// SPDX-License-Identifier: MIT
// One file or sensor of a record as a sequence of events. MergedReader puts several together by (stamp,
// stream).
#pragma once

#include <optional>

#include "atlas/sensor/record_reader.hpp"

namespace atlas::record {

/// Half-open [begin, end).
struct TimeSpan {
  Stamp begin = kBeginOfTime, end = kEndOfTime;
  [[nodiscard]] bool contains(Stamp stamp) const { return stamp >= begin && stamp < end; }
};

class EventSource {
 public:
  virtual ~EventSource() = default;
  /// Stamp of the first event; nullopt without any. Called before limit().
  virtual std::optional<Stamp> firstStamp() = 0;
  /// Stamp of the last event as far as it is cheap to know.
  virtual std::optional<Stamp> lastStamp() = 0;
  /// Only events inside are delivered, the others are counted. Called once, before the first next().
  virtual void limit(const TimeSpan& span) = 0;
  /// Events in (stamp, stream) order; after nullopt all rows are accounted for.
  virtual std::optional<Event> next() = 0;
};

}  // namespace atlas::record
