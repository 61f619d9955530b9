// SPDX-License-Identifier: MIT
#include "atlas/lidar/point_cells.hpp"

namespace atlas {

PointCells::PointCells(const std::vector<LidarPoint>& points, double radius_m)
    : points_(points), radius_m_(radius_m) {
  std::vector<std::uint32_t> cell_of(points.size(), VoxelIndex::kNone);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto key = voxelOf(points[i].x, points[i].y, points[i].z, radius_m);
    if (key) cell_of[i] = index_.insert(*key);
  }
  begin_.assign(index_.size() + 1, 0);
  for (const std::uint32_t cell : cell_of)
    begin_[cell == VoxelIndex::kNone ? 0 : cell + 1] += cell != VoxelIndex::kNone;
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  members_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cell_of[i] != VoxelIndex::kNone) members_[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace atlas
