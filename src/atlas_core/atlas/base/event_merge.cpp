// SPDX-License-Identifier: MIT
#include "atlas/base/event_merge.hpp"

#include <algorithm>
#include <utility>

#include "atlas/base/check.hpp"

namespace atlas {

EventMerge::EventMerge(std::vector<std::string> stream_names) {
  ATLAS_CHECK(!stream_names.empty(), "event merge needs at least one stream");
  for (std::string& name : stream_names) {
    streams_.emplace_back();
    streams_.back().name = std::move(name);
  }
}

void EventMerge::push(std::size_t stream, Stamp stamp, Action action) {
  Stream& s = streams_.at(stream);
  ++s.received;
  const bool behind_dispatched =
      stamp < dispatched_stamp_ || (stamp == dispatched_stamp_ && stream < dispatched_stream_);
  // The end of a stream is the watermark kEndOfTime, so events after it are late, too.
  if (stamp <= s.watermark || behind_dispatched || stamp < s.last_pushed) {
    ++s.late;
    return;
  }
  s.last_pushed = stamp;
  s.queue.push_back({stamp, std::move(action)});
  dispatchDue();
}

void EventMerge::advance(std::size_t stream, Stamp watermark) {
  Stream& s = streams_.at(stream);
  if (watermark <= s.watermark) return;
  s.watermark = watermark;
  dispatchDue();
}

std::size_t EventMerge::earliestHead() const {
  std::size_t earliest = streams_.size();
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    if (streams_[i].queue.empty()) continue;
    if (earliest == streams_.size() ||
        streams_[i].queue.front().stamp < streams_[earliest].queue.front().stamp) {
      earliest = i;  // on equal stamps the smaller index stays
    }
  }
  return earliest;
}

std::size_t EventMerge::blockingStream() const {
  const std::size_t head = earliestHead();
  if (head == streams_.size()) return streams_.size();
  const Stamp stamp = streams_[head].queue.front().stamp;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    if (i == head || !streams_[i].queue.empty()) continue;
    // A later event of stream i would go first if its stamp were smaller, or equal with a smaller index.
    const Stamp needed = i < head ? stamp : stamp - 1;
    if (streams_[i].watermark < needed) return i;
  }
  return streams_.size();
}

void EventMerge::dispatchDue() {
  if (dispatching_) return;  // an action pushed into its own merge: the outer loop goes on with it
  struct Guard {
    bool& flag;
    explicit Guard(bool& f) : flag(f) { flag = true; }
    ~Guard() { flag = false; }
  } guard(dispatching_);
  while (true) {
    const std::size_t head = earliestHead();
    if (head == streams_.size() || blockingStream() != streams_.size()) return;
    Event event = std::move(streams_[head].queue.front());
    streams_[head].queue.pop_front();
    dispatched_stamp_ = event.stamp;
    dispatched_stream_ = head;
    event.action();
  }
}

Stamp EventMerge::watermark() const {
  Stamp result = kEndOfTime;
  for (const Stream& s : streams_) {
    Stamp reached = s.watermark;
    if (!s.queue.empty()) {
      reached = s.queue.front().stamp - 1;
    } else if (s.last_pushed != kBeginOfTime) {
      reached = std::max(reached, s.last_pushed - 1);  // an earlier event would be late
    }
    result = std::min(result, reached);
  }
  // The event whose action is running is not done yet.
  return dispatching_ ? std::min(result, dispatched_stamp_ - 1) : result;
}

std::size_t EventMerge::queued() const {
  std::size_t sum = 0;
  for (const Stream& s : streams_) sum += s.queue.size();
  return sum;
}

}  // namespace atlas
