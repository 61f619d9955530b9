// SPDX-License-Identifier: MIT
#include "atlas/fusion/neighbour_grid.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace atlas {
namespace {

constexpr double kFarthestCell = 1e15;  ///< beyond any map; keeps the conversion defined

}  // namespace

std::int64_t NeighbourGrid::cellOf(double value) const {
  return static_cast<std::int64_t>(std::clamp(std::floor(value / cell_m_), -kFarthestCell, kFarthestCell));
}

NeighbourGrid::NeighbourGrid(const std::vector<Eigen::Vector2d>& points, double cell_m)
    : points_(points), cell_m_(cell_m) {
  entries_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    entries_.push_back({cellOf(points[i].x()), cellOf(points[i].y()), static_cast<std::uint32_t>(i)});
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.cell_x, a.cell_y, a.index) < std::tie(b.cell_x, b.cell_y, b.index);
  });
}

std::vector<std::uint32_t> NeighbourGrid::nearest(const Eigen::Vector2d& place, double radius_m,
                                                  std::size_t most) const {
  std::vector<std::pair<double, std::uint32_t>> found;
  const std::int64_t low_y = cellOf(place.y() - radius_m), high_y = cellOf(place.y() + radius_m);
  for (std::int64_t x = cellOf(place.x() - radius_m); x <= cellOf(place.x() + radius_m); ++x) {
    auto it = std::lower_bound(entries_.begin(), entries_.end(), std::make_pair(x, low_y),
                               [](const Entry& e, const std::pair<std::int64_t, std::int64_t>& key) {
                                 return std::tie(e.cell_x, e.cell_y) < std::tie(key.first, key.second);
                               });
    for (; it != entries_.end() && it->cell_x == x && it->cell_y <= high_y; ++it) {
      const double distance = (points_[it->index] - place).norm();
      if (distance <= radius_m) found.emplace_back(distance, it->index);
    }
  }
  const std::size_t count = std::min(most, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), found.end());
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(found[i].second);
  return result;
}

}  // namespace atlas
