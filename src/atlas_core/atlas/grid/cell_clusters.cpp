// SPDX-License-Identifier: MIT
#include "atlas/grid/cell_clusters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "atlas/lidar/oriented_box.hpp"

namespace atlas {
namespace {

constexpr double kStandingVariance = 0.1;   ///< m^2/s^2, of a cell that surely stands
constexpr double kAlike_sq = 4.0;           ///< Mahalanobis distance of velocities that may be the same
constexpr std::size_t kCellsOfOutline = 8;  ///< fewer show no sides
constexpr float kSeen = 0.55F;              ///< evidence of a cell that a sensor sees occupied

/// Velocity of the thing in a cell, standing or moving.
ClusterCell cellAt(const ClusteringInput& input, int column, int row) {
  const std::size_t i = input.geometry.indexOf(column, row);
  const CellEstimates& cells = input.cells;
  ClusterCell cell;
  cell.index = static_cast<std::uint32_t>(i);
  cell.position = input.geometry.middleOf(column, row);
  cell.weight = cells.occupied[i];
  cell.static_share = cells.static_share[i];
  cell.top_m = input.top_m[i];
  cell.seen = input.evidence[i] > kSeen;
  const double moves = 1.0 - cell.static_share;
  const Eigen::Vector2d v(cells.vx_mps[i], cells.vy_mps[i]);
  cell.velocity = moves * v;
  // of one side of a car nobody can tell whether it stands: that is an uncertainty, not a velocity of its own
  cell.variance = kStandingVariance + moves * (cells.var_xx[i] + cells.var_yy[i]) +
                  moves * (1.0 - moves) * v.squaredNorm();
  return cell;
}

bool moveAlike(const ClusterCell& a, const ClusterCell& b, double gate_sq) {
  const double difference_sq = (a.velocity - b.velocity).squaredNorm();
  return difference_sq <= gate_sq || difference_sq <= kAlike_sq * (a.variance + b.variance);
}

}  // namespace

CellClusters clusterCells(const ClusteringInput& input, double occupied, double velocity_gate_mps) {
  const GridGeometry& geometry = input.geometry;
  const double gate_sq = velocity_gate_mps * velocity_gate_mps;
  CellClusters result;
  result.cluster_of_cell.assign(geometry.cells(), 0);
  const auto is_occupied = [&](std::size_t i) { return input.cells.occupied[i] >= occupied; };
  std::vector<std::pair<int, int>> waiting;
  for (int row = 0; row < geometry.rows; ++row) {
    for (int column = 0; column < geometry.columns; ++column) {
      const std::size_t start = geometry.indexOf(column, row);
      if (result.cluster_of_cell[start] != 0 || !is_occupied(start)) continue;
      result.clusters.emplace_back();
      const auto number = static_cast<std::int32_t>(result.clusters.size());
      result.cluster_of_cell[start] = number;
      waiting.assign(1, {column, row});
      while (!waiting.empty()) {
        const auto [x, y] = waiting.back();
        waiting.pop_back();
        const ClusterCell cell = cellAt(input, x, y);
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            if (!geometry.contains(x + dx, y + dy)) continue;
            const std::size_t next = geometry.indexOf(x + dx, y + dy);
            if (result.cluster_of_cell[next] != 0 || !is_occupied(next)) continue;
            if (!moveAlike(cell, cellAt(input, x + dx, y + dy), gate_sq)) continue;
            result.cluster_of_cell[next] = number;
            waiting.emplace_back(x + dx, y + dy);
          }
        }
        result.clusters.back().push_back(cell);
      }
    }
  }
  return result;
}

GroundBox boxAlong(const Cluster& cells, double yaw_rad, double cell_m) {
  const Eigen::Vector2d along(std::cos(yaw_rad), std::sin(yaw_rad)), across(-along.y(), along.x());
  Eigen::Array2d low(1e18, 1e18), high(-1e18, -1e18);
  for (const ClusterCell& cell : cells) {
    const Eigen::Array2d p(cell.position.dot(along), cell.position.dot(across));
    low = low.min(p);
    high = high.max(p);
  }
  GroundBox box;
  box.yaw_rad = yaw_rad;
  box.center = 0.5 * (low.x() + high.x()) * along + 0.5 * (low.y() + high.y()) * across;
  box.length = high.x() - low.x() + cell_m;
  box.width = high.y() - low.y() + cell_m;
  return box;
}

GroundBox principalBox(const Cluster& cells, double cell_m) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const ClusterCell& cell : cells) mean += cell.position;
  mean /= static_cast<double>(cells.size());
  double xx = 0, xy = 0, yy = 0;
  for (const ClusterCell& cell : cells) {
    const Eigen::Vector2d d = cell.position - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  GroundBox box = boxAlong(cells, 0.5 * std::atan2(2.0 * xy, xx - yy), cell_m);
  if (box.width > box.length) box = boxAlong(cells, box.yaw_rad + M_PI / 2.0, cell_m);
  return box;
}

GroundBox outlineBox(const Cluster& cells, const Eigen::Vector2d& seen_from_map, double cell_m) {
  if (cells.size() < kCellsOfOutline) return principalBox(cells, cell_m);
  const Eigen::Vector2d origin = cells.front().position;  // floats are exact enough around it
  std::vector<LidarPoint> points(cells.size());
  std::vector<std::uint32_t> members(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    points[i].x = static_cast<float>(cells[i].position.x() - origin.x());
    points[i].y = static_cast<float>(cells[i].position.y() - origin.y());
    members[i] = static_cast<std::uint32_t>(i);
  }
  const Eigen::Vector2d eye = seen_from_map - origin;
  const Outcome<Obstacle> fit = fitBox(points, members, {eye.x(), eye.y(), 0.0});
  return boxAlong(cells, fit->yaw_rad, cell_m);
}

}  // namespace atlas
