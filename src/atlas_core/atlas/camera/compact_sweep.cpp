// SPDX-License-Identifier: MIT
#include "atlas/camera/compact_sweep.hpp"

#include <cstdint>
#include <limits>
#include <utility>

namespace atlas {

CompactSweepPtr compacted(const BatchedSweep& batched, Origin origin) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  const std::vector<LidarPoint>& points = batched.sweep->points;
  auto result = std::make_shared<CompactSweep>();
  result->stamp = batched.stamp;
  result->origin = std::move(origin);
  result->batches.resize(batched.batches.size());
  std::vector<std::uint32_t> batch_of(points.size(), kNone);
  forEachPoint(batched, [&](std::size_t i, const Batch& batch) {
    const auto b = static_cast<std::size_t>(&batch - batched.batches.data());
    if (!result->batches[b].bounds.add({points[i].x, points[i].y, points[i].z})) return;
    batch_of[i] = static_cast<std::uint32_t>(b);
    ++result->batches[b].end;  // the count, until the next loop
  });
  std::size_t sum = 0;
  for (std::size_t b = 0; b < result->batches.size(); ++b) {
    CompactSweep::Batch& batch = result->batches[b];
    batch.stamp = batched.batches[b].stamp;
    batch.T_map_lidar = batched.batches[b].T_map_lidar;
    const std::size_t count = batch.end;
    batch.first = batch.end = sum;  // the end moves as points come
    sum += count;
  }
  for (std::vector<float>* axis : {&result->x, &result->y, &result->z}) axis->resize(sum);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (batch_of[i] == kNone) continue;
    const std::size_t to = result->batches[batch_of[i]].end++;
    result->x[to] = points[i].x;
    result->y[to] = points[i].y;
    result->z[to] = points[i].z;
  }
  return result;
}

CompactSweepPtr compactedOnce(const BatchedSweep& batched, const Origin& origin) {
  const CompactSweepPtr kept = batched.compact.get([&] { return compacted(batched, origin); });
  const bool same = kept->origin.topic == origin.topic && kept->origin.index == origin.index;
  return same ? kept : compacted(batched, origin);
}

}  // namespace atlas
