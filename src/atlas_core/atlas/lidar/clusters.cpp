// SPDX-License-Identifier: MIT
#include "atlas/lidar/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/lidar/voxel.hpp"

namespace atlas {
namespace {

/// Share of the tolerance within which a low piece is the rest of a tall one: what stands in front of a wall
/// keeps some distance, a wall's own parts do not.
constexpr float kTight = 0.3F;
constexpr int kRestSteps = 8;  ///< pieces that a rest may be away from the tall one

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

/// Says of most free columns that they are free, from a few kilobytes that stay in the fastest cache.
class OccupiedColumns {
 public:
  explicit OccupiedColumns(const std::vector<VoxelKey>& keys) : bits_(kBits / 64, 0) {
    for (const VoxelKey& key : keys)
      bits_[bitOf(key.x, key.y) / 64] |= std::uint64_t{1} << (bitOf(key.x, key.y) % 64);
  }
  [[nodiscard]] bool mayHold(std::int32_t x, std::int32_t y) const {
    const std::uint32_t bit = bitOf(x, y);
    return (bits_[bit / 64] >> (bit % 64) & 1U) != 0;
  }

 private:
  static constexpr std::uint32_t kBits = 1U << 17U;
  static std::uint32_t bitOf(std::int32_t x, std::int32_t y) {
    return (static_cast<std::uint32_t>(x) * 0x9E3779B1U + static_cast<std::uint32_t>(y) * 0x85EBCA77U) >> 15U;
  }
  std::vector<std::uint64_t> bits_;
};

/// Part of a column without a gap in height.
struct Piece {
  float x_min, x_max, y_min, y_max, z_min, z_max;  ///< m, map
  std::uint32_t points;

  void add(const Piece& other) {
    x_min = std::min(x_min, other.x_min);
    x_max = std::max(x_max, other.x_max);
    y_min = std::min(y_min, other.y_min);
    y_max = std::max(y_max, other.y_max);
    z_min = std::min(z_min, other.z_min);
    z_max = std::max(z_max, other.z_max);
    points += other.points;
  }
};

float gap(float a_min, float a_max, float b_min, float b_max) {
  return std::max(0.0F, std::max(b_min - a_max, a_min - b_max));
}

class ColumnClusters {
 public:
  ColumnClusters(const std::vector<LidarPoint>& points, const Eigen::Vector3d& vehicle_map,
                 const ClusterParams& params)
      : points_(points), vehicle_(vehicle_map), params_(params), index_(points.size() / 4) {
    sortIntoColumns();
    cutIntoPieces();
    linkColumns();
    markTall();
    joinLinks();
  }

  [[nodiscard]] std::vector<std::vector<std::uint32_t>> take() {
    std::vector<std::uint32_t> cluster_of_root(pieces_.size(), VoxelIndex::kNone);
    std::vector<std::vector<std::uint32_t>> clusters;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (piece_of_point_[i] == VoxelIndex::kNone) continue;
      std::uint32_t& cluster = cluster_of_root[sets_.find(piece_of_point_[i])];
      if (cluster == VoxelIndex::kNone) {
        cluster = static_cast<std::uint32_t>(clusters.size());
        clusters.emplace_back();
      }
      clusters[cluster].push_back(static_cast<std::uint32_t>(i));
    }
    return clusters;
  }

 private:
  void sortIntoColumns() {
    std::vector<std::uint32_t> column_of_point;
    column_of_point.reserve(points_.size());
    for (const LidarPoint& p : points_) {
      const auto key = std::isfinite(p.z) ? voxelOf(p.x, p.y, 0.0F, params_.column_m) : std::nullopt;
      column_of_point.push_back(key ? index_.insert(*key) : VoxelIndex::kNone);
    }
    begin_.assign(index_.size() + 1, 0);
    for (const std::uint32_t column : column_of_point) {
      if (column != VoxelIndex::kNone) ++begin_[column + 1];
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    members_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (column_of_point[i] != VoxelIndex::kNone)
        members_[next[column_of_point[i]]++] = {points_[i].z, static_cast<std::uint32_t>(i)};
    }
  }

  void cutIntoPieces() {
    piece_of_point_.assign(points_.size(), VoxelIndex::kNone);
    first_piece_.push_back(0);
    for (std::size_t column = 0; column < index_.size(); ++column) {
      const VoxelKey& key = index_.keys()[column];
      const double range_m = std::hypot((key.x + 0.5) * params_.column_m - vehicle_.x(),
                                        (key.y + 0.5) * params_.column_m - vehicle_.y());
      tolerance_.push_back(static_cast<float>(params_.tolerance_m + params_.tolerance_per_m * range_m));
      step_.push_back(static_cast<float>(params_.step_m + params_.step_per_m * range_m));
      const auto first = members_.begin() + begin_[column], last = members_.begin() + begin_[column + 1];
      std::sort(first, last, [](const Member& a, const Member& b) { return a.z < b.z; });
      for (auto member = first; member != last; ++member) {
        const LidarPoint& p = points_[member->point];
        if (member == first || p.z - pieces_.back().z_max > step_.back())
          pieces_.push_back({p.x, p.x, p.y, p.y, p.z, p.z, 0});
        pieces_.back().add({p.x, p.x, p.y, p.y, p.z, p.z, 1});
        piece_of_point_[member->point] = static_cast<std::uint32_t>(pieces_.size() - 1);
      }
      first_piece_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    }
  }

  void linkColumns() {
    const std::vector<VoxelKey>& keys = index_.keys();
    const OccupiedColumns occupied(keys);
    for (std::uint32_t a = 0; a < keys.size(); ++a) {
      const auto reach = static_cast<std::int32_t>(static_cast<double>(tolerance_[a]) / params_.column_m) + 1;
      for (std::int32_t dx = 0; dx <= reach; ++dx) {
        for (std::int32_t dy = dx == 0 ? 1 : -reach; dy <= reach; ++dy) {
          linkNeighbour(a, keys[a].x + dx, keys[a].y + dy, occupied);
        }
      }
    }
  }

  /// The nearer column's tolerance counts: whichever of the two is looked from, the other lies in its reach.
  void linkNeighbour(std::uint32_t a, std::int32_t x, std::int32_t y, const OccupiedColumns& occupied) {
    if (!occupied.mayHold(x, y)) return;
    const std::uint32_t b = index_.find({x, y, 0});
    if (b == VoxelIndex::kNone) return;
    const float tolerance = std::min(tolerance_[a], tolerance_[b]), step = std::min(step_[a], step_[b]);
    for (std::uint32_t i = first_piece_[a]; i < first_piece_[a + 1]; ++i) {
      for (std::uint32_t j = first_piece_[b]; j < first_piece_[b + 1]; ++j) {
        const Piece &p = pieces_[i], &q = pieces_[j];
        const float gx = gap(p.x_min, p.x_max, q.x_min, q.x_max),
                    gy = gap(p.y_min, p.y_max, q.y_min, q.y_max);
        const float apart_sq = gx * gx + gy * gy;
        if (apart_sq <= tolerance * tolerance && gap(p.z_min, p.z_max, q.z_min, q.z_max) <= step)
          links_.push_back({i, j, apart_sq <= kTight * kTight * tolerance * tolerance});
      }
    }
  }

  /// Tall pieces and, next to them, the low rests of what they belong to: window bays, parts behind a car.
  void markTall() {
    is_tall_.reserve(pieces_.size());
    for (const Piece& p : pieces_)
      is_tall_.push_back(static_cast<double>(p.z_max - p.z_min) > params_.tall_m ? 1 : 0);
    for (int step = 0; step < kRestSteps; ++step) {
      std::vector<std::uint32_t> rests;
      for (const Link& link : links_) {
        if (link.tight && is_tall_[link.a] != is_tall_[link.b])
          rests.push_back(is_tall_[link.a] != 0 ? link.b : link.a);
      }
      for (const std::uint32_t piece : rests) is_tall_[piece] = 1;
    }
  }

  [[nodiscard]] bool mayBeObject(const Piece& whole) const {
    const float diagonal = std::hypot(whole.x_max - whole.x_min, whole.y_max - whole.y_min);
    return static_cast<double>(diagonal) <= params_.object_m &&
           static_cast<double>(whole.z_max - whole.z_min) <= params_.tall_m &&
           static_cast<int>(whole.points) >= params_.fewest_points;
  }

  /// Low clusters at a tall one are a rest of it, unless they may be an object.
  void joinLinks() {
    sets_ = DisjointSets(pieces_.size());
    for (const Link& link : links_) {
      if (is_tall_[link.a] == is_tall_[link.b]) sets_.unite(link.a, link.b);
    }
    std::vector<Piece> whole = pieces_;  // of each cluster, at its root
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      const std::uint32_t root = sets_.find(i);
      if (root != i) whole[root].add(pieces_[i]);
    }
    std::vector<Link> rests;
    for (const Link& link : links_) {
      if (is_tall_[link.a] == is_tall_[link.b]) continue;
      const Piece& low = whole[sets_.find(is_tall_[link.a] != 0 ? link.b : link.a)];
      if (!mayBeObject(low)) rests.push_back(link);
    }
    for (const Link& link : rests) sets_.unite(link.a, link.b);
  }

  /// Two pieces whose gap is within the tolerance.
  struct Link {
    std::uint32_t a, b;
    bool tight;  ///< within kTight of it
  };
  struct Member {
    float z;
    std::uint32_t point;
  };
  const std::vector<LidarPoint>& points_;
  const Eigen::Vector3d vehicle_;
  const ClusterParams& params_;
  VoxelIndex index_;                        ///< of columns, as voxels of height 0
  std::vector<std::uint32_t> begin_;        ///< into members, one more than columns
  std::vector<Member> members_;             ///< by column, then from the bottom
  std::vector<float> tolerance_, step_;     ///< m, of each column
  std::vector<std::uint32_t> first_piece_;  ///< of each column, one more than columns
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> piece_of_point_;
  DisjointSets sets_{0};
  std::vector<Link> links_;
  std::vector<char> is_tall_;  ///< of each piece
};

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("clustering: " + what + ", got " + std::to_string(value));
}

}  // namespace

std::vector<std::vector<std::uint32_t>> findClusters(const std::vector<LidarPoint>& points_map,
                                                     const Eigen::Vector3d& vehicle_map,
                                                     const ClusterParams& params) {
  need(params.column_m > 0.0, "column_m must be positive", params.column_m);
  need(params.tolerance_m > 0.0, "tolerance_m must be positive", params.tolerance_m);
  need(params.tolerance_per_m >= 0.0, "tolerance_per_m must not be negative", params.tolerance_per_m);
  need(params.step_m > 0.0, "step_m must be positive", params.step_m);
  need(params.step_per_m >= 0.0, "step_per_m must not be negative", params.step_per_m);
  return ColumnClusters(points_map, vehicle_map, params).take();
}

}  // namespace atlas
