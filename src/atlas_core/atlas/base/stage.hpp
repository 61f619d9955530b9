// SPDX-License-Identifier: MIT
// What every stage of the suite has in common: inputs merged by event time, a progress, counters.
// The same stage objects run inside the nodelets (fed from topics) and inside the offline pipeline (fed
// directly), so both give the same bits. A stage is single-threaded, never blocks and never looks at a clock.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "atlas/base/counters.hpp"
#include "atlas/base/event_merge.hpp"
#include "atlas/base/time.hpp"

namespace atlas {

class Stage {
 public:
  Stage(std::string name, std::vector<std::string> input_names)
      : name_(std::move(name)), merge_(std::move(input_names)) {}
  virtual ~Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t inputs() const { return merge_.streams(); }
  [[nodiscard]] const std::string& inputName(std::size_t input) const { return merge_.name(input); }

  /// No further event on `input` at or before `watermark`. May emit outputs.
  void advance(std::size_t input, Stamp watermark) {
    merge_.advance(input, watermark);
    afterInput();
  }
  /// `input` has ended. When the last one has, the stage flushes (onEnd) and progress() becomes kEndOfTime.
  void finish(std::size_t input) { advance(input, kEndOfTime); }

  /// Every output with a stamp at or before this has been emitted; kEndOfTime once all is done.
  [[nodiscard]] Stamp progress() const {
    if (ended_) return kEndOfTime;
    const Stamp merged = merge_.watermark();
    const Stamp held = heldBackFrom();
    return held <= merged && held != kBeginOfTime ? held - 1 : merged;
  }
  [[nodiscard]] bool ended() const { return ended_; }

  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] const EventMerge& merge() const { return merge_; }

 protected:
  /// Queues `action` for `input` at `stamp`; it runs when its turn has come in the merged order.
  void enqueue(std::size_t input, Stamp stamp, EventMerge::Action action) {
    merge_.push(input, stamp, std::move(action));
    afterInput();
  }
  /// Smallest stamp of an output that the stage still owes for inputs it has already taken; kEndOfTime when
  /// none.
  [[nodiscard]] virtual Stamp heldBackFrom() const { return kEndOfTime; }
  /// Called after events were dispatched or watermarks moved; merge().watermark() tells how far the inputs
  /// are known.
  virtual void onProgress() {}
  /// Called once when all inputs have ended: answer whatever is still held back.
  virtual void onEnd() {}

  Counters counters_;

 private:
  void afterInput() {
    if (ended_) return;
    onProgress();
    if (merge_.finished()) {
      onEnd();
      ended_ = true;
    }
  }

  std::string name_;
  EventMerge merge_;
  bool ended_ = false;
};

}  // namespace atlas
