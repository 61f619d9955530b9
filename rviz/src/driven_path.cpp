// SPDX-License-Identifier: MIT
#include "driven_path.hpp"

namespace atlas_rviz {

bool DrivenPath::add(const atlas::Odometry& odometry) {
  if (odometry.stamp < stamp_) points_.clear();
  stamp_ = odometry.stamp;
  const Eigen::Vector3d& position = odometry.T_map_imu.translation;
  if (!points_.empty() && (position - points_.back().position).norm() < kStep) return false;
  points_.push_back({position, odometry.velocity_imu_mps.norm()});
  if (points_.size() > kMostPoints) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
    points_.resize(kept);
  }
  return true;
}

}  // namespace atlas_rviz
