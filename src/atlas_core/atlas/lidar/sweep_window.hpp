// SPDX-License-Identifier: MIT
// The sweeps of the last seconds, shared and untransformed (paper IV-B: PointCloudAggregator).
#pragma once

#include <deque>

#include "atlas/base/time.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

class SweepWindow {
 public:
  explicit SweepWindow(Duration length) : length_(length) {}
  /// Sweeps come in stamp order; those without pose are not kept.
  void push(const BatchedSweepPtr& sweep) {
    if (!sweep->batches.empty()) sweeps_.push_back(sweep);
  }
  /// Drops the sweeps at or before `now` - length: what stays has its stamp in (now - length, ...].
  void forget(Stamp now) {
    while (!sweeps_.empty() && sweeps_.front()->stamp <= now - length_) sweeps_.pop_front();
  }
  void clear() { sweeps_.clear(); }
  [[nodiscard]] const std::deque<BatchedSweepPtr>& sweeps() const { return sweeps_; }
  [[nodiscard]] Duration length() const { return length_; }

 private:
  Duration length_;
  std::deque<BatchedSweepPtr> sweeps_;
};

}  // namespace atlas
