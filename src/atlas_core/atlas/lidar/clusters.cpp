// SPDX-License-Identifier: MIT
#include "atlas/lidar/clusters.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "atlas/lidar/voxel.hpp"

namespace atlas {
namespace {

/// Disjoint sets; the smaller number is the root, so roots do not depend on the order of unions.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    for (std::size_t i = 0; i < size; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t ra = find(a), rb = find(b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The points of each cell, cells in order of first appearance.
struct Cells {
  VoxelIndex index;
  std::vector<std::uint32_t> cell_of_point;  ///< VoxelIndex::kNone for points that are not finite
  std::vector<std::uint32_t> begin;          ///< into members, one more than cells
  std::vector<std::uint32_t> members;        ///< point indices, ascending within a cell
};

Cells sortIntoCells(const std::vector<LidarPoint>& points, double edge_m) {
  Cells cells{VoxelIndex(points.size() / 2), {}, {}, {}};
  cells.cell_of_point.reserve(points.size());
  for (const LidarPoint& p : points) {
    const std::optional<VoxelKey> key = voxelOf(p.x, p.y, p.z, edge_m);
    cells.cell_of_point.push_back(key ? cells.index.insert(*key) : VoxelIndex::kNone);
  }
  cells.begin.assign(cells.index.size() + 1, 0);
  for (const std::uint32_t cell : cells.cell_of_point) {
    if (cell != VoxelIndex::kNone) ++cells.begin[cell + 1];
  }
  for (std::size_t i = 1; i < cells.begin.size(); ++i) cells.begin[i] += cells.begin[i - 1];
  cells.members.resize(cells.begin.back());
  std::vector<std::uint32_t> next(cells.begin.begin(), cells.begin.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t cell = cells.cell_of_point[i];
    if (cell != VoxelIndex::kNone) cells.members[next[cell]++] = static_cast<std::uint32_t>(i);
  }
  return cells;
}

bool anyPairWithin(const std::vector<LidarPoint>& points, const Cells& cells, std::uint32_t a,
                   std::uint32_t b, double tolerance_sq) {
  for (std::uint32_t i = cells.begin[a]; i < cells.begin[a + 1]; ++i) {
    const LidarPoint& p = points[cells.members[i]];
    for (std::uint32_t j = cells.begin[b]; j < cells.begin[b + 1]; ++j) {
      const LidarPoint& q = points[cells.members[j]];
      const double dx = static_cast<double>(p.x) - q.x, dy = static_cast<double>(p.y) - q.y,
                   dz = static_cast<double>(p.z) - q.z;
      if (dx * dx + dy * dy + dz * dz <= tolerance_sq) return true;
    }
  }
  return false;
}

/// Says of most free cells that they are free, from a few kilobytes that stay in the fastest cache: three of
/// four neighbours of a cell on a surface are free.
class OccupiedCells {
 public:
  explicit OccupiedCells(const std::vector<VoxelKey>& keys) : bits_(kBits / 64, 0) {
    for (const VoxelKey& key : keys) bits_[bitOf(key) / 64] |= std::uint64_t{1} << (bitOf(key) % 64);
  }
  [[nodiscard]] bool mayHold(const VoxelKey& key) const {
    const std::uint32_t bit = bitOf(key);
    return (bits_[bit / 64] >> (bit % 64) & 1U) != 0;
  }

 private:
  static constexpr std::uint32_t kBits = 1U << 17U;
  static std::uint32_t bitOf(const VoxelKey& key) {
    return (static_cast<std::uint32_t>(key.x) * 0x9E3779B1U +
            static_cast<std::uint32_t>(key.y) * 0x85EBCA77U +
            static_cast<std::uint32_t>(key.z) * 0xC2B2AE3DU) >>
           15U;
  }
  std::vector<std::uint64_t> bits_;
};

/// One of each pair of opposite neighbours that can hold a point within tolerance = sqrt(3) edges, nearest
/// first: near neighbours usually join at once, and what is joined already needs no comparison of points.
std::vector<VoxelKey> halfNeighbourhood() {
  std::array<std::vector<VoxelKey>, 13> by_distance;
  for (std::int32_t x = -2; x <= 2; ++x) {
    for (std::int32_t y = -2; y <= 2; ++y) {
      for (std::int32_t z = -2; z <= 2; ++z) {
        const bool half = x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0)));
        if (half) by_distance.at(static_cast<std::uint32_t>(x * x + y * y + z * z)).push_back({x, y, z});
      }
    }
  }
  std::vector<VoxelKey> result;
  for (const auto& shell : by_distance) result.insert(result.end(), shell.begin(), shell.end());
  return result;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> euclideanClusters(const std::vector<LidarPoint>& points,
                                                          double tolerance_m) {
  if (!(tolerance_m > 0.0)) {
    throw std::invalid_argument("clustering: tolerance_m must be positive, got " +
                                std::to_string(tolerance_m));
  }
  // The diagonal of a cell is a hair shorter than the tolerance, so that all points of a cell belong
  // together.
  const double edge_m = tolerance_m / std::sqrt(3.0) * (1.0 - 1e-9);
  const Cells cells = sortIntoCells(points, edge_m);
  const std::vector<VoxelKey>& keys = cells.index.keys();
  DisjointSets sets(keys.size());
  const OccupiedCells occupied(keys);
  for (const VoxelKey& step : halfNeighbourhood()) {
    for (std::uint32_t a = 0; a < keys.size(); ++a) {
      const VoxelKey neighbour{keys[a].x + step.x, keys[a].y + step.y, keys[a].z + step.z};
      if (!occupied.mayHold(neighbour)) continue;
      const std::uint32_t b = cells.index.find(neighbour);
      if (b == VoxelIndex::kNone || sets.find(a) == sets.find(b)) continue;
      if (anyPairWithin(points, cells, a, b, tolerance_m * tolerance_m)) sets.unite(a, b);
    }
  }
  std::vector<std::uint32_t> cluster_of_root(keys.size(), VoxelIndex::kNone);
  std::vector<std::vector<std::uint32_t>> clusters;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cells.cell_of_point[i] == VoxelIndex::kNone) continue;
    std::uint32_t& cluster = cluster_of_root[sets.find(cells.cell_of_point[i])];
    if (cluster == VoxelIndex::kNone) {
      cluster = static_cast<std::uint32_t>(clusters.size());
      clusters.emplace_back();
    }
    clusters[cluster].push_back(static_cast<std::uint32_t>(i));
  }
  return clusters;
}

}  // namespace atlas
