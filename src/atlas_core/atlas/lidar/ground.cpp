// SPDX-License-Identifier: MIT
#include "atlas/lidar/ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace atlas {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLowFraction = 0.05;  ///< percentile that a cell proposes: below it are stray reflections
constexpr double kSeedFraction =
    0.3;  ///< of the proposals near the vehicle: more of them are road than roofs
constexpr double kSeedRadius_m = 10.0;  ///< where the first estimate is taken
constexpr double kMaxDoubt_m = 3.0;     ///< a gap wider than this makes nothing else believable
constexpr int kReach = 3;               ///< cells that support a cell

double fractile(std::vector<double>& values, double fraction) {
  const auto k = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

}  // namespace

template <class Use>
void GroundGrid::forNeighbours(int ix, int iy, int reach, Use&& use) const {
  for (int y = std::max(0, iy - reach); y <= std::min(side_ - 1, iy + reach); ++y) {
    for (int x = std::max(0, ix - reach); x <= std::min(side_ - 1, ix + reach); ++x) {
      const int distance_sq = (x - ix) * (x - ix) + (y - iy) * (y - iy);
      if (distance_sq == 0 || distance_sq > reach * reach) continue;
      use(cell(x, y), params_.cell_m * std::sqrt(static_cast<double>(distance_sq)));
    }
  }
}

GroundGrid::GroundGrid(const std::vector<LidarPoint>& points, const Eigen::Vector3d& center_map,
                       const GroundParams& params)
    : params_(params) {
  const double edge = params.cell_m;
  origin_x_ = std::floor((center_map.x() - params.radius_m) / edge) * edge;
  origin_y_ = std::floor((center_map.y() - params.radius_m) / edge) * edge;
  side_ = static_cast<int>(std::ceil(2.0 * params.radius_m / edge)) + 1;
  vehicle_x_ = (center_map.x() - origin_x_) / edge;
  vehicle_y_ = (center_map.y() - origin_y_) / edge;
  cells_.assign(static_cast<std::size_t>(side_ * side_), Cell{});
  propose(points);
  grow();
  fill();
  center(points);
}

bool GroundGrid::cellOf(double x, double y, int& ix, int& iy) const {
  const double cx = std::floor((x - origin_x_) / params_.cell_m),
               cy = std::floor((y - origin_y_) / params_.cell_m);
  if (!(cx >= 0.0 && cy >= 0.0 && cx < side_ && cy < side_)) return false;
  ix = static_cast<int>(cx);
  iy = static_cast<int>(cy);
  return true;
}

void GroundGrid::propose(const std::vector<LidarPoint>& points) {
  std::vector<std::pair<std::uint32_t, double>> heights;  // (cell, z)
  heights.reserve(points.size());
  int ix = 0, iy = 0;
  for (const LidarPoint& p : points) {
    if (cellOf(p.x, p.y, ix, iy)) heights.emplace_back(static_cast<std::uint32_t>(iy * side_ + ix), p.z);
  }
  std::sort(heights.begin(), heights.end());
  for (Cell& c : cells_) c.proposal_m = kNan;
  for (std::size_t begin = 0; begin < heights.size();) {
    std::size_t end = begin;
    while (end < heights.size() && heights[end].first == heights[begin].first) ++end;
    const auto low = static_cast<std::size_t>(kLowFraction * static_cast<double>(end - begin));
    cells_[heights[begin].first].proposal_m = heights[begin + low].second;
    begin = end;
  }
}

double GroundGrid::seedHeight() const {
  std::vector<double> near, all;
  for (int iy = 0; iy < side_; ++iy) {
    for (int ix = 0; ix < side_; ++ix) {
      const double proposal = cell(ix, iy).proposal_m;
      if (std::isnan(proposal)) continue;
      all.push_back(proposal);
      const double distance_m = params_.cell_m * std::hypot(ix + 0.5 - vehicle_x_, iy + 0.5 - vehicle_y_);
      if (distance_m <= kSeedRadius_m) near.push_back(proposal);
    }
  }
  std::vector<double>& values = near.empty() ? all : near;
  return values.empty() ? kNan : fractile(values, kSeedFraction);
}

/// From the vehicle outwards: every cell is judged by those nearer to the vehicle.
void GroundGrid::grow() {
  const double seed_m = seedHeight();
  if (std::isnan(seed_m)) {
    for (Cell& c : cells_) c.height_m = kNan;
    return;
  }
  std::vector<std::pair<double, std::uint32_t>> order;  // (squared distance, cell): a total order
  order.reserve(cells_.size());
  for (int iy = 0; iy < side_; ++iy) {
    for (int ix = 0; ix < side_; ++ix) {
      const double dx = ix + 0.5 - vehicle_x_, dy = iy + 0.5 - vehicle_y_;
      order.emplace_back(dx * dx + dy * dy, static_cast<std::uint32_t>(iy * side_ + ix));
    }
  }
  std::sort(order.begin(), order.end());
  for (const auto& [distance_sq, index] : order) {
    visit(static_cast<int>(index) % side_, static_cast<int>(index) / side_, seed_m);
  }
}

void GroundGrid::visit(int ix, int iy, double seed_m) {
  std::vector<double> believed, guessed;
  double believed_reach_m = 0.0, doubt_m = kMaxDoubt_m;
  forNeighbours(ix, iy, kReach, [&](const Cell& neighbour, double distance_m) {
    if (!neighbour.visited) return;
    if (neighbour.believed) {
      believed.push_back(neighbour.height_m);
      believed_reach_m += distance_m;
    } else {
      guessed.push_back(neighbour.height_m);
      doubt_m = std::min(doubt_m, neighbour.doubt_m + distance_m);
    }
  });
  double expected_m = seed_m;
  if (!believed.empty()) {
    doubt_m =
        believed_reach_m / static_cast<double>(believed.size());  // mean distance: the slope acts over it
    expected_m = fractile(believed, 0.5);
  } else if (!guessed.empty()) {
    expected_m = fractile(guessed, 0.5);
  }
  Cell& c = cell(ix, iy);
  c.visited = true;
  // NaN proposals end as not believed
  c.believed = std::abs(c.proposal_m - expected_m) <= params_.max_step_m + params_.max_slope * doubt_m;
  c.height_m = c.believed ? c.proposal_m : expected_m;
  c.doubt_m = c.believed ? 0.0 : std::min(kMaxDoubt_m, doubt_m);
}

/// Cells that were not measured lie between the measured ones around them, on both sides.
void GroundGrid::fill() {
  const std::vector<Cell> grown = cells_;
  for (int iy = 0; iy < side_; ++iy) {
    for (int ix = 0; ix < side_; ++ix) {
      if (cell(ix, iy).believed) continue;
      double sum = 0.0, weights = 0.0;
      forNeighbours(ix, iy, kReach, [&](const Cell& neighbour, double distance_m) {
        if (!neighbour.believed) return;  // heights of believed cells do not change in this loop
        const double weight = 1.0 / (distance_m * distance_m);
        sum += weight * neighbour.height_m;
        weights += weight;
      });
      if (weights > 0.0) cell(ix, iy).height_m = sum / weights;
    }
  }
}

/// The lowest points of a cell lie at its lower end on a slope; the mean of its ground points lies in its
/// middle.
void GroundGrid::center(const std::vector<LidarPoint>& points) {
  std::vector<std::pair<double, std::uint32_t>> sums(cells_.size(), {0.0, 0U});
  int ix = 0, iy = 0;
  for (const LidarPoint& p : points) {
    if (!cellOf(p.x, p.y, ix, iy) || !cell(ix, iy).believed) continue;
    const double above_m = static_cast<double>(p.z) - heightAt(p.x, p.y);
    if (std::abs(above_m) > params_.tolerance_m) continue;
    auto& [sum, count] = sums[static_cast<std::size_t>(iy * side_ + ix)];
    sum += static_cast<double>(p.z);
    ++count;
  }
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (sums[i].second >= 3) cells_[i].height_m = sums[i].first / sums[i].second;
  }
}

double GroundGrid::heightAt(double x, double y) const {
  int ix = 0, iy = 0;
  if (!cellOf(x, y, ix, iy)) return kNan;
  const double last = side_ - 1;
  const double cx = std::clamp((x - origin_x_) / params_.cell_m - 0.5, 0.0,
                               last);  // cell centres; flat half cell at the rim
  const double cy = std::clamp((y - origin_y_) / params_.cell_m - 0.5, 0.0, last);
  const int x0 = std::min(static_cast<int>(cx), side_ - 2), y0 = std::min(static_cast<int>(cy), side_ - 2);
  const double u = cx - x0, v = cy - y0;
  return (1 - v) * ((1 - u) * cell(x0, y0).height_m + u * cell(x0 + 1, y0).height_m) +
         v * ((1 - u) * cell(x0, y0 + 1).height_m + u * cell(x0 + 1, y0 + 1).height_m);
}

std::size_t GroundGrid::believedCells() const {
  return static_cast<std::size_t>(
      std::count_if(cells_.begin(), cells_.end(), [](const Cell& c) { return c.believed; }));
}

}  // namespace atlas
