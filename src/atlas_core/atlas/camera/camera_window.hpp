// SPDX-License-Identifier: MIT
// The sweeps that an image may be made from: those of the last seconds before it.
#pragma once

#include <deque>
#include <vector>

#include "atlas/base/time.hpp"
#include "atlas/camera/compact_sweep.hpp"

namespace atlas {

class CameraWindow {
 public:
  explicit CameraWindow(Duration length) : length_(length) {}

  /// Sweeps come in stamp order; those without pose are not kept (null), those that no image at or after this
  /// stamp can see are dropped.
  CompactSweepPtr push(const BatchedSweepPtr& batched) {
    const CompactSweepPtr sweep = batched->batches.empty() ? nullptr : compacted(*batched);
    if (sweep) sweeps_.push_back(sweep);
    while (!sweeps_.empty() && sweeps_.front()->stamp <= batched->stamp - length_) sweeps_.pop_front();
    return sweep;
  }
  /// Those with a stamp in (stamp - length, ...], oldest first.
  [[nodiscard]] std::vector<CompactSweepPtr> since(Stamp stamp) const {
    std::vector<CompactSweepPtr> result;
    for (const CompactSweepPtr& sweep : sweeps_) {
      if (sweep->stamp > stamp - length_) result.push_back(sweep);
    }
    return result;
  }
  [[nodiscard]] std::size_t size() const { return sweeps_.size(); }

 private:
  Duration length_;
  std::deque<CompactSweepPtr> sweeps_;
};

}  // namespace atlas
