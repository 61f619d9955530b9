// SPDX-License-Identifier: MIT
// Merges the inputs of a stage by event time, so that arrival order has no influence on any result.
// Order is total: (stamp, stream index, order within the stream). An event is dispatched once every other
// stream has shown, by its own next event, by a watermark or by its end, that it cannot deliver an earlier
// one (the idea of cartographer's OrderedMultiQueue; watermarks as in Akidau et al. 2015, "The Dataflow
// Model").
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "atlas/base/time.hpp"

namespace atlas {

class EventMerge {
 public:
  using Action = std::function<void()>;

  explicit EventMerge(std::vector<std::string> stream_names);

  /// Queues an event and dispatches all that are due (its action may run now or in a later call). An event at
  /// or before its own stream's watermark, or before what was already dispatched, is late: counted, never
  /// dispatched.
  void push(std::size_t stream, Stamp stamp, Action action);
  /// Promise: no further event of `stream` has a stamp at or before `watermark`. A smaller one is ignored.
  void advance(std::size_t stream, Stamp watermark);
  /// Promise: no further event of `stream` at all.
  void finish(std::size_t stream) { advance(stream, kEndOfTime); }

  /// Every event at or before this stamp has been dispatched; kEndOfTime when all streams have ended.
  [[nodiscard]] Stamp watermark() const;
  [[nodiscard]] bool finished() const { return watermark() == kEndOfTime; }

  [[nodiscard]] std::size_t streams() const { return streams_.size(); }
  [[nodiscard]] const std::string& name(std::size_t stream) const { return streams_.at(stream).name; }
  [[nodiscard]] std::uint64_t late(std::size_t stream) const { return streams_.at(stream).late; }
  [[nodiscard]] std::uint64_t received(std::size_t stream) const { return streams_.at(stream).received; }
  [[nodiscard]] std::size_t queued() const;
  /// The stream that the others wait for; streams() when nothing waits. For diagnostics.
  [[nodiscard]] std::size_t blockingStream() const;

 private:
  struct Event {
    Stamp stamp;
    Action action;
  };
  struct Stream {
    std::string name;
    std::deque<Event> queue;
    Stamp watermark = kBeginOfTime;
    Stamp last_pushed = kBeginOfTime;
    std::uint64_t received = 0;
    std::uint64_t late = 0;
  };
  void dispatchDue();
  [[nodiscard]] std::size_t earliestHead() const;

  std::vector<Stream> streams_;
  Stamp dispatched_stamp_ = kBeginOfTime;  ///< key of the last dispatched event: (stamp, stream)
  std::size_t dispatched_stream_ = 0;
  bool dispatching_ = false;
};

}  // namespace atlas
