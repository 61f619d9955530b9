// SPDX-License-Identifier: MIT
#include "atlas/camera/batch_bounds.hpp"

#include <cmath>

namespace atlas {

void BatchBounds::add(const LidarPoint& point) {
  const Eigen::Vector3f p(point.x, point.y, point.z);
  const float range = p.norm();
  if (!(range > 0.0F && std::isfinite(range))) return;
  const Eigen::Vector3f direction = p / range;
  if (empty()) {
    low_direction = high_direction = direction;
    min_range_m = max_range_m = range;
    return;
  }
  low_direction = low_direction.cwiseMin(direction);
  high_direction = high_direction.cwiseMax(direction);
  min_range_m = std::min(min_range_m, range);
  max_range_m = std::max(max_range_m, range);
}

BoundedSweepPtr withBounds(const BatchedSweepPtr& batched) {
  auto result = std::make_shared<BoundedSweep>();
  result->batched = batched;
  result->bounds.resize(batched->batches.size());
  const LidarPoint* points = batched->sweep->points.data();
  forEachPoint(*batched, [&](std::size_t i, const Batch& batch) {
    result->bounds[static_cast<std::size_t>(&batch - batched->batches.data())].add(points[i]);
  });
  return result;
}

}  // namespace atlas
