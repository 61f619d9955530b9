// SPDX-License-Identifier: MIT
// The way driven so far, thinned, so that its memory is bounded however long the drive is.
#pragma once

#include <vector>

#include "atlas/sensor/products.hpp"

namespace atlas_rviz {

class DrivenPath {
 public:
  struct Point {
    Eigen::Vector3d position;  ///< m, map
    double speed_mps;
  };

  /// True when the path has grown. A stamp before the last one (the drive began anew) clears the path first.
  bool add(const atlas::Odometry& odometry);
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] atlas::Stamp stamp() const { return stamp_; }  ///< of the last odometry

  static constexpr double kStep = 0.5;                ///< m, shortest piece
  static constexpr std::size_t kMostPoints = 10'000;  ///< then every second one goes

 private:
  std::vector<Point> points_;
  atlas::Stamp stamp_ = atlas::kBeginOfTime;
};

}  // namespace atlas_rviz
