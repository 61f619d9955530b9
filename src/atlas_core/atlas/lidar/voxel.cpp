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
}

void VoxelFilter::add(const LidarPoint& point) {
  const std::optional<VoxelKey> key = voxelOf(point.x, point.y, point.z, edge_m_);
  if (!key) return;
  Last& last = last_[point.ring % last_.size()];
  if (last.voxel == VoxelIndex::kNone || !(last.key == *key)) last = {*key, index_.insert(*key)};
  const std::uint32_t voxel = last.voxel;
  if (voxel == points_.size()) points_.push_back(point);
  if (keep_ == VoxelPoint::kFirst) return;
  if (voxel == sums_.size()) sums_.emplace_back();
  Sum& sum = sums_[voxel];
  sum.x += static_cast<double>(point.x);
  sum.y += static_cast<double>(point.y);
  sum.z += static_cast<double>(point.z);
  sum.intensity += static_cast<double>(point.intensity);
  ++sum.count;
}

std::vector<LidarPoint> VoxelFilter::take() {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const double count = sums_[i].count;
    points_[i].x = static_cast<float>(sums_[i].x / count);
    points_[i].y = static_cast<float>(sums_[i].y / count);
    points_[i].z = static_cast<float>(sums_[i].z / count);
    points_[i].intensity = static_cast<float>(sums_[i].intensity / count);
  }
  return std::move(points_);
}

std::vector<LidarPoint> voxelFiltered(const std::vector<LidarPoint>& points, double edge_m, VoxelPoint keep) {
  VoxelFilter filter(edge_m, keep, points.size() / 4);
  for (const LidarPoint& point : points) filter.add(point);
  return filter.take();
}

}  // namespace atlas
