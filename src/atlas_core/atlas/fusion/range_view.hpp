// SPDX-License-Identifier: MIT
// What one lidar sweep says of a place: something is there, something nearer hides it, or the beams went
// through. An object that was not found is missed only as far as beams went through its place.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/fusion/measurement.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

class RangeView {
 public:
  /// Smallest distance in each cell of azimuth and elevation around the lidar, of a part of the points: an
  /// odd step takes all lasers in turn. Nothing is known when the sweep has no pose.
  explicit RangeView(const BatchedSweep& sweep);

  [[nodiscard]] bool empty() const { return ranges_.empty(); }
  [[nodiscard]] Stamp stamp() const { return stamp_; }
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }

  /// Cells that the place of an object covers, by what was measured in them.
  struct Census {
    int through = 0, there = 0, hidden = 0, nothing = 0;
  };
  [[nodiscard]] Census census(const TrackShape& object) const;
  /// Beside a box, just left or right of it, something nearer ends: what follows of the object is hidden.
  struct Sides {
    bool left = false, right = false;
  };
  [[nodiscard]] Sides hiddenSides(const Obstacle& box) const;

 private:
  struct Window {
    double nearest_m = 0, farthest_m = 0;
    double left_rad = 0, right_rad = 0, middle_rad = 0;  ///< of the middle; left > 0 > right relative to it
    double left_m = 0, right_m = 0;                      ///< distances of the outermost corners
    int low = 0, high = -1;                              ///< rows
  };
  [[nodiscard]] Window windowOf(const Eigen::Vector2d& center, double yaw_rad, double length, double width,
                                double bottom, double top) const;
  [[nodiscard]] float at(int row, int column) const;
  [[nodiscard]] bool nearerAt(double azimuth_rad, double distance_m, const Window& window) const;

  Stamp stamp_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<float> ranges_;  ///< by row and column; 0 = no return
};

}  // namespace atlas
