// SPDX-License-Identifier: MIT
#include "atlas/lidar/voxel.hpp"

#include <stdexcept>
#include <string>

namespace atlas {

VoxelFilter::VoxelFilter(double edge_m, VoxelPoint keep, std::size_t expected)
    : edge_m_(edge_m), keep_(keep), index_(expected) {
  if (!(edge_m > 0.0)) {
    throw std::invalid_argument("voxel filter: edge_m must be positive, got " + std::to_string(edge_m));
  }
  points_.reserve(expected);
  if (keep == VoxelPoint::kCentroid) sums_.reserve(expected);
}

void VoxelFilter::add(const LidarPoint& point) {
  const std::optional<VoxelKey> key = voxelOf(point.x, point.y, point.z, edge_m_);
  if (!key) return;
  Last& last = last_[point.ring % last_.size()];
  if (last.voxel == VoxelIndex::kNone || !(last.key == *key)) last = {*key, index_.insert(*key)};
  const std::uint32_t voxel = last.voxel;
  if (voxel == points_.size()) {
    points_.push_back(point);
    if (keep_ == VoxelPoint::kCentroid) sums_.emplace_back();
    return;
  }
  if (keep_ == VoxelPoint::kFirst) return;
  const LidarPoint& first = points_[voxel];
  Sum& sum = sums_[voxel];
  sum.x += point.x - first.x;
  sum.y += point.y - first.y;
  sum.z += point.z - first.z;
  sum.intensity += point.intensity - first.intensity;
  ++sum.count;
}

std::vector<LidarPoint> VoxelFilter::take() {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const float share = 1.0F / static_cast<float>(sums_[i].count);
    points_[i].x += share * sums_[i].x;
    points_[i].y += share * sums_[i].y;
    points_[i].z += share * sums_[i].z;
    points_[i].intensity += share * sums_[i].intensity;
  }
  return std::move(points_);
}

std::vector<LidarPoint> voxelFiltered(const std::vector<LidarPoint>& points, double edge_m, VoxelPoint keep) {
  VoxelFilter filter(edge_m, keep, points.size() / 3);
  for (const LidarPoint& point : points) filter.add(point);
  return filter.take();
}

}  // namespace atlas
