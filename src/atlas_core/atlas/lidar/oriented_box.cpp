// SPDX-License-Identifier: MIT
#include "atlas/lidar/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace atlas {
namespace {

constexpr double kMinDistance_m = 0.05;  ///< points nearer to a side than this are equally near: lidar noise
constexpr int kCoarseSteps = 30;         ///< of 3 deg over a quarter turn
constexpr double kCoarse_rad = M_PI / 2.0 / kCoarseSteps;
constexpr int kFineSteps = 5;          ///< of 0.6 deg to either side
constexpr std::size_t kSectors = 128;  ///< of the angle under which a cluster is seen: one point each

/// Extent of the points along a direction.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double size() const { return high - low; }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// Distances to that end of the extent which the points lie nearer to, as a whole.
bool nearerToLow(const std::vector<double>& c, const Extent& extent) {
  double to_low_sq = 0.0, to_high_sq = 0.0;
  for (const double value : c) {
    to_low_sq += (value - extent.low) * (value - extent.low);
    to_high_sq += (extent.high - value) * (extent.high - value);
  }
  return to_low_sq <= to_high_sq;
}

class YawSearch {
 public:
  explicit YawSearch(std::vector<Eigen::Vector2d> points) : points_(std::move(points)) {
    c1_.resize(points_.size());
    c2_.resize(points_.size());
  }
  [[nodiscard]] double best() {
    double best_rad = 0.0, best_score = -1.0;
    const auto consider = [&](double yaw_rad) {
      const double score = closeness(yaw_rad);
      if (score > best_score) {
        best_score = score;
        best_rad = yaw_rad;
      }
    };
    for (int i = 0; i < kCoarseSteps; ++i) consider(i * kCoarse_rad);
    const double coarse_rad = best_rad;
    for (int i = -kFineSteps; i <= kFineSteps; ++i) {
      if (i != 0) consider(coarse_rad + i * kCoarse_rad / kFineSteps);
    }
    return best_rad;
  }

 private:
  /// sum over the points of 1 / max(d, d0), d = distance to the nearer of the two seen sides.
  double closeness(double yaw_rad) {
    const double cosine = std::cos(yaw_rad), sine = std::sin(yaw_rad);
    Extent e1, e2;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      c1_[i] = cosine * points_[i].x() + sine * points_[i].y();
      c2_[i] = -sine * points_[i].x() + cosine * points_[i].y();
      e1.add(c1_[i]);
      e2.add(c2_[i]);
    }
    const bool low1 = nearerToLow(c1_, e1), low2 = nearerToLow(c2_, e2);
    double score = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double d1 = low1 ? c1_[i] - e1.low : e1.high - c1_[i];
      const double d2 = low2 ? c2_[i] - e2.low : e2.high - c2_[i];
      score += 1.0 / std::max(kMinDistance_m, std::min(d1, d2));
    }
    return score;
  }

  std::vector<Eigen::Vector2d> points_;
  std::vector<double> c1_, c2_;
};

/// The nearest point of each sector as seen from `eye`; points and eye relative to one of the points.
std::vector<Eigen::Vector2d> outlineOf(const std::vector<Eigen::Vector2d>& points,
                                       const Eigen::Vector2d& eye) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) middle += p;
  const Eigen::Vector2d ahead = middle / static_cast<double>(points.size()) - eye;
  const auto bearing = [&](const Eigen::Vector2d& p) {  // from -1 to 1 about `ahead` or further off
    const Eigen::Vector2d d = p - eye;
    const double along = ahead.dot(d), across = ahead.x() * d.y() - ahead.y() * d.x();
    return across / (std::abs(across) + std::abs(along)) + (along < 0.0 ? (across < 0.0 ? -1.0 : 1.0) : 0.0);
  };
  Extent seen;
  std::vector<double> bearings;
  bearings.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    bearings.push_back(bearing(p));
    seen.add(bearings.back());
  }
  const double sector = std::max(1e-9, seen.size()) / (static_cast<double>(kSectors) - 0.5);
  std::vector<std::size_t> nearest(kSectors, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t& best =
        nearest[std::min(kSectors - 1, static_cast<std::size_t>((bearings[i] - seen.low) / sector))];
    if (best == points.size() || (points[i] - eye).squaredNorm() < (points[best] - eye).squaredNorm())
      best = i;
  }
  std::vector<Eigen::Vector2d> outline;
  for (const std::size_t i : nearest) {
    if (i < points.size()) outline.push_back(points[i]);
  }
  return outline;
}

}  // namespace

Outcome<Obstacle> fitBox(const std::vector<LidarPoint>& points_map, const std::vector<std::uint32_t>& members,
                         const Eigen::Vector3d& seen_from_map) {
  if (members.empty()) return Reason::kEmpty;
  // relative to the first point: coordinates of some kilometres would cost digits
  const LidarPoint& first = points_map[members.front()];
  const Eigen::Vector3d origin(first.x, first.y, first.z);
  std::vector<Eigen::Vector2d> plan;
  plan.reserve(members.size());
  for (const std::uint32_t i : members) {
    const LidarPoint& p = points_map[i];
    plan.emplace_back(p.x - origin.x(), p.y - origin.y());
  }
  double yaw_rad = YawSearch(outlineOf(plan, (seen_from_map - origin).head<2>())).best();

  const double cosine = std::cos(yaw_rad), sine = std::sin(yaw_rad);
  Extent along, across, up;
  for (const std::uint32_t i : members) {
    const LidarPoint& p = points_map[i];
    const double x = p.x - origin.x(), y = p.y - origin.y();
    along.add(cosine * x + sine * y);
    across.add(-sine * x + cosine * y);
    up.add(p.z - origin.z());
  }
  Obstacle box;
  box.points = static_cast<std::uint32_t>(members.size());
  box.center = origin + Eigen::Vector3d(cosine * along.middle() - sine * across.middle(),
                                        sine * along.middle() + cosine * across.middle(), up.middle());
  box.size = {along.size(), across.size(), up.size()};
  if (box.size.y() > box.size.x()) {
    std::swap(box.size.x(), box.size.y());
    yaw_rad += M_PI / 2.0;
  }
  while (yaw_rad > M_PI / 2.0) yaw_rad -= M_PI;  // a box has no front: half a turn is the same box
  while (yaw_rad <= -M_PI / 2.0) yaw_rad += M_PI;
  box.yaw_rad = yaw_rad;
  return box;
}

}  // namespace atlas
