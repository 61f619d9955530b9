// SPDX-License-Identifier: MIT
// Points of the plane sorted into square cells, for the question which of them are near a place.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace atlas {

class NeighbourGrid {
 public:
  NeighbourGrid(const std::vector<Eigen::Vector2d>& points, double cell_m);
  /// Indices of the points within `radius_m` of the place, the nearest first, at most `most`; of equally near
  /// ones the smaller index first.
  [[nodiscard]] std::vector<std::uint32_t> nearest(const Eigen::Vector2d& place, double radius_m,
                                                   std::size_t most) const;

 private:
  struct Entry {
    std::int64_t cell_x, cell_y;
    std::uint32_t index;
  };
  [[nodiscard]] std::int64_t cellOf(double value) const;

  const std::vector<Eigen::Vector2d>& points_;
  double cell_m_;
  std::vector<Entry> entries_;  ///< by column of cells, then by row
};

}  // namespace atlas
