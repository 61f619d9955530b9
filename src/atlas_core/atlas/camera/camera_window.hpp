// SPDX-License-Identifier: MIT
// The sweeps that an image may be made from: those of the last seconds before it.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "atlas/base/time.hpp"
#include "atlas/camera/compact_sweep.hpp"

namespace atlas {

/// Counts the sweeps of each lidar, so that images can tell which they were made from.
class SweepOrigins {
 public:
  explicit SweepOrigins(const std::vector<std::string>& lidars) {
    for (const std::string& lidar : lidars) next_.push_back({lidar + "/batches", 0, 0, {}});
  }
  /// Of the next sweep of a lidar; call for every one, in order of arrival.
  Origin next(std::size_t lidar, Stamp stamp) {
    Origin origin = next_.at(lidar);
    origin.stamp = stamp;
    ++*next_[lidar].index;
    return origin;
  }

 private:
  std::vector<Origin> next_;
};
/// Adds those of the sweeps, and of the pose at the stamp of the product.
inline void addOrigins(ProductOrigins& product, const std::vector<CompactSweepPtr>& sweeps) {
  for (const CompactSweepPtr& sweep : sweeps) product.origins.push_back(sweep->origin);
  product.origins.push_back({"odometry", product.stamp, {}, {}});
}

class CameraWindow {
 public:
  explicit CameraWindow(Duration length) : length_(length) {}

  /// Sweeps come in stamp order; those without pose are not kept (null), those that no image at or after this
  /// stamp can see are dropped.
  CompactSweepPtr push(const BatchedSweepPtr& batched, const Origin& origin = {}) {
    const CompactSweepPtr sweep = batched->batches.empty() ? nullptr : compactedOnce(*batched, origin);
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
