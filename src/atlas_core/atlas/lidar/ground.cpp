// SPDX-License-Identifier: MIT
#include "atlas/lidar/ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace atlas {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLowFraction = 0.05;  ///< percentile that a cell proposes: below it are stray reflections
constexpr double kSeedFraction =
    0.3;  ///< of the proposals near the vehicle: more of them are road than roofs
constexpr double kSeedRadius_m = 10.0;  ///< where the first estimate is taken
constexpr double kMaxDoubt_m = 3.0;     ///< a gap wider than this makes nothing else believable
constexpr int kReach = 3;               ///< cells that support a cell
constexpr int kFewestForPlane = 5;      ///< believed cells; fewer of them tell no slope
constexpr double kSlopeSigma = 0.1;     ///< of roads, against the plane's residuals of kHeightSigma_m
constexpr double kHeightSigma_m = 0.05;
constexpr std::size_t kMostForMedian = 64;  ///< points of a cell, spread evenly, that tell its middle

/// Reorders the values.
template <class Iterator>
double fractile(Iterator first, Iterator last, double fraction) {
  const auto k = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(last - first - 1));
  std::nth_element(first, first + k, last);
  return static_cast<double>(*(first + k));
}
double fractile(std::vector<double>& values, double fraction) {
  return fractile(values.begin(), values.end(), fraction);
}

double median(std::vector<double>& values) {
  const double lower = fractile(values, 0.5);  // what lies behind it is not smaller
  if (values.size() % 2 == 1) return lower;
  return 0.5 * (lower + *std::min_element(values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                                          values.end()));
}

/// Plane through the believed neighbours of a cell, as seen from its centre; slopes drawn towards level
/// ground as far as the neighbours do not determine them.
class PlaneFit {
 public:
  void add(double dx, double dy, double height_m) {
    const Eigen::Vector3d row(1.0, dx, dy);
    normal_ += row * row.transpose();
    right_ += height_m * row;
    ++count_;
  }
  [[nodiscard]] int count() const { return count_; }
  /// Height at the centre.
  [[nodiscard]] double height() const {
    constexpr double kWeight = (kHeightSigma_m / kSlopeSigma) * (kHeightSigma_m / kSlopeSigma);
    Eigen::Matrix3d normal = normal_;
    normal(1, 1) += kWeight;
    normal(2, 2) += kWeight;
    return (normal.inverse() * right_).x();
  }
  [[nodiscard]] double mean() const { return right_.x() / count_; }

 private:
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

}  // namespace

/// Which points lie in which cell.
struct GroundGrid::PointsOfCells {
  std::vector<std::uint32_t> begin;    ///< into members, one more than cells
  std::vector<std::uint32_t> members;  ///< point indices, ascending within a cell
  std::vector<float> heights_m;        ///< of the members, until propose() reorders them within their cell
};

template <class Use>
void GroundGrid::forNeighbours(int ix, int iy, int reach, Use&& use) const {
  for (int y = std::max(0, iy - reach); y <= std::min(side_ - 1, iy + reach); ++y) {
    for (int x = std::max(0, ix - reach); x <= std::min(side_ - 1, ix + reach); ++x) {
      const int distance_sq = (x - ix) * (x - ix) + (y - iy) * (y - iy);
      if (distance_sq == 0 || distance_sq > reach * reach) continue;
      use(cell(x, y), x - ix, y - iy);
    }
  }
}

GroundGrid::GroundGrid(const std::vector<LidarPoint>& points, const Eigen::Vector3d& center_map,
                       const GroundParams& params)
    : params_(params) {
  const double edge = params.cell_m;
  cells_per_m_ = 1.0 / edge;
  origin_x_ = std::floor((center_map.x() - params.radius_m) / edge) * edge;
  origin_y_ = std::floor((center_map.y() - params.radius_m) / edge) * edge;
  side_ = static_cast<int>(std::ceil(2.0 * params.radius_m / edge)) + 1;
  vehicle_x_ = (center_map.x() - origin_x_) / edge;
  vehicle_y_ = (center_map.y() - origin_y_) / edge;
  cells_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), Cell{});
  PointsOfCells in_cells = sortIntoCells(points);
  propose(in_cells);
  grow();
  fill();
  center(points, in_cells);
}

bool GroundGrid::cellOf(double x, double y, int& ix, int& iy) const {
  const double cx = (x - origin_x_) * cells_per_m_, cy = (y - origin_y_) * cells_per_m_;
  if (!(cx >= 0.0 && cy >= 0.0 && cx < side_ && cy < side_)) return false;
  ix = static_cast<int>(cx);
  iy = static_cast<int>(cy);
  return true;
}

GroundGrid::PointsOfCells GroundGrid::sortIntoCells(const std::vector<LidarPoint>& points) const {
  constexpr std::uint32_t kOutside = std::numeric_limits<std::uint32_t>::max();
  PointsOfCells result;
  result.begin.assign(cells_.size() + 1, 0);
  std::vector<std::uint32_t> cell_of_point(points.size(), kOutside);
  int ix = 0, iy = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!cellOf(points[i].x, points[i].y, ix, iy)) continue;
    cell_of_point[i] = static_cast<std::uint32_t>(iy * side_ + ix);
    ++result.begin[cell_of_point[i] + 1];
  }
  for (std::size_t i = 1; i < result.begin.size(); ++i) result.begin[i] += result.begin[i - 1];
  result.members.resize(result.begin.back());
  result.heights_m.resize(result.begin.back());
  std::vector<std::uint32_t> next(result.begin.begin(), result.begin.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cell_of_point[i] == kOutside) continue;
    const std::uint32_t place = next[cell_of_point[i]]++;
    result.members[place] = static_cast<std::uint32_t>(i);
    result.heights_m[place] = points[i].z;
  }
  return result;
}

void GroundGrid::propose(PointsOfCells& in_cells) {
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const auto first = in_cells.heights_m.begin() + in_cells.begin[cell],
               last = in_cells.heights_m.begin() + in_cells.begin[cell + 1];
    cells_[cell].proposal_m = first == last ? kNan : fractile(first, last, kLowFraction);
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
  for (const std::uint32_t index : outwards())
    visit(static_cast<int>(index) % side_, static_cast<int>(index) / side_, seed_m);
}

/// All cells by their distance to the vehicle in whole cells, row by row where it is the same.
std::vector<std::uint32_t> GroundGrid::outwards() const {
  std::vector<std::uint32_t> ring(cells_.size()), begin;
  for (int iy = 0; iy < side_; ++iy) {
    for (int ix = 0; ix < side_; ++ix) {
      const auto distance =
          static_cast<std::uint32_t>(2.0 * std::hypot(ix + 0.5 - vehicle_x_, iy + 0.5 - vehicle_y_));
      ring[indexOf(ix, iy)] = distance;
      if (distance + 2 > begin.size()) begin.resize(distance + 2, 0);
      ++begin[distance + 1];
    }
  }
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<std::uint32_t> order(cells_.size());
  for (std::size_t i = 0; i < ring.size(); ++i) order[begin[ring[i]]++] = static_cast<std::uint32_t>(i);
  return order;
}

void GroundGrid::visit(int ix, int iy, double seed_m) {
  PlaneFit plane;
  std::vector<double>& guessed = guessed_;
  guessed.clear();
  double believed_reach_m = 0.0, doubt_m = kMaxDoubt_m;
  forNeighbours(ix, iy, kReach, [&](const Cell& neighbour, int dx, int dy) {
    if (!neighbour.visited) return;
    const double distance_m = params_.cell_m * std::sqrt(static_cast<double>(dx * dx + dy * dy));
    if (neighbour.believed) {
      plane.add(params_.cell_m * dx, params_.cell_m * dy, neighbour.height_m);
      believed_reach_m += distance_m;
    } else {
      guessed.push_back(neighbour.height_m);
      doubt_m = std::min(doubt_m, neighbour.doubt_m + distance_m);
    }
  });
  double expected_m = seed_m, limit = params_.max_slope;
  if (plane.count() > 0) {
    doubt_m = believed_reach_m / plane.count();  // mean distance: slope or bend act over it
    const bool enough = plane.count() >= kFewestForPlane;
    expected_m = enough ? plane.height() : plane.mean();
    if (enough) limit = params_.max_bend;
  } else if (!guessed.empty()) {
    expected_m = fractile(guessed, 0.5);
  }
  Cell& c = cell(ix, iy);
  c.visited = true;
  // NaN proposals end as not believed
  c.believed = std::abs(c.proposal_m - expected_m) <= params_.max_step_m + limit * doubt_m;
  c.height_m = c.believed ? c.proposal_m : expected_m;
  c.doubt_m = c.believed ? 0.0 : std::min(kMaxDoubt_m, doubt_m);
}

/// Cells that were not measured lie between the measured ones around them, on both sides.
void GroundGrid::fill() {
  for (int iy = 0; iy < side_; ++iy) {
    for (int ix = 0; ix < side_; ++ix) {
      if (cell(ix, iy).believed) continue;
      double sum = 0.0, weights = 0.0;
      forNeighbours(ix, iy, kReach, [&](const Cell& neighbour, int dx, int dy) {
        if (!neighbour.believed) return;  // heights of believed cells do not change in this loop
        const double weight = 1.0 / (dx * dx + dy * dy);
        sum += weight * neighbour.height_m;
        weights += weight;
      });
      if (weights > 0.0) cell(ix, iy).height_m = sum / weights;
    }
  }
}

/// The lowest points of a cell lie at its lower end on a slope, and below the road by their noise: the median
/// of its ground points above the surface so far lies in its middle. A mean would be lifted by the feet of
/// what stands on the road.
void GroundGrid::center(const std::vector<LidarPoint>& points, const PointsOfCells& in_cells) {
  std::vector<double> lifts_m(cells_.size(), 0.0), above_m;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (!cells_[cell].believed) continue;
    above_m.clear();
    const std::size_t stride = (in_cells.begin[cell + 1] - in_cells.begin[cell]) / kMostForMedian + 1;
    for (std::size_t i = in_cells.begin[cell]; i < in_cells.begin[cell + 1]; i += stride) {
      const LidarPoint& p = points[in_cells.members[i]];
      const double above = static_cast<double>(p.z) - heightAt(p.x, p.y);
      if (std::abs(above) <= params_.tolerance_m) above_m.push_back(above);
    }
    if (above_m.size() >= 3) lifts_m[cell] = median(above_m);
  }
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) cells_[cell].height_m += lifts_m[cell];
}

double GroundGrid::heightAt(double x, double y) const {
  int ix = 0, iy = 0;
  if (!cellOf(x, y, ix, iy)) return kNan;
  const double last = side_ - 1;  // between cell centres; flat in the half cell at the rim
  const double cx = std::clamp((x - origin_x_) * cells_per_m_ - 0.5, 0.0, last);
  const double cy = std::clamp((y - origin_y_) * cells_per_m_ - 0.5, 0.0, last);
  const int x0 = std::min(static_cast<int>(cx), side_ - 2), y0 = std::min(static_cast<int>(cy), side_ - 2);
  const double u = cx - x0, v = cy - y0;
  const Cell *low = &cells_[indexOf(x0, y0)], *high = low + side_;
  return (1 - v) * ((1 - u) * low[0].height_m + u * low[1].height_m) +
         v * ((1 - u) * high[0].height_m + u * high[1].height_m);
}

std::size_t GroundGrid::believedCells() const {
  return static_cast<std::size_t>(
      std::count_if(cells_.begin(), cells_.end(), [](const Cell& c) { return c.believed; }));
}

}  // namespace atlas
