// SPDX-License-Identifier: MIT
// Points sorted into cells as large as a radius, so that the neighbours of a point lie in 27 of them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "atlas/lidar/voxel.hpp"

namespace atlas {

class PointCells {
 public:
  /// Keeps a reference to the points. Points that are not finite are nobody's neighbours.
  PointCells(const std::vector<LidarPoint>& points, double radius_m);

  /// Calls visit(index, position - center) for every point within the radius, itself included; in an order
  /// that depends on the points alone.
  template <class Visit>
  void around(const LidarPoint& center, Visit&& visit) const {
    const auto key = voxelOf(center.x, center.y, center.z, radius_m_);
    if (!key) return;
    const Eigen::Vector3d middle(center.x, center.y, center.z);
    for (int cell = 0; cell < 27; ++cell) {
      const std::uint32_t number =
          index_.find({key->x + cell / 9 - 1, key->y + cell / 3 % 3 - 1, key->z + cell % 3 - 1});
      if (number == VoxelIndex::kNone) continue;
      for (std::size_t i = begin_[number]; i < begin_[number + 1]; ++i) {
        const LidarPoint& p = points_[members_[i]];
        const Eigen::Vector3d offset = Eigen::Vector3d(p.x, p.y, p.z) - middle;
        if (offset.squaredNorm() <= radius_m_ * radius_m_) visit(members_[i], offset);
      }
    }
  }

 private:
  const std::vector<LidarPoint>& points_;
  double radius_m_;
  VoxelIndex index_;
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> members_;  ///< by cell, in the order of the points
};

}  // namespace atlas
