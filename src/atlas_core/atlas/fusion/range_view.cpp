// SPDX-License-Identifier: MIT
#include "atlas/fusion/range_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "atlas/base/geometry.hpp"

namespace atlas {
namespace {

constexpr int kColumns = 360, kRows = 48;
constexpr double kColumn_rad = 2.0 * M_PI / kColumns;
constexpr double kLowest_rad = -0.7,
                 kRow_rad = 0.025;  ///< finer than the lasers of the usual sensors are apart
constexpr std::size_t kMostPoints = 25000;
constexpr double kTolerance_m = 0.5;  ///< before and behind an object
constexpr double kFoot_m = 0.25;      ///< what is lower may be ground
constexpr double kStep_m = 0.7;       ///< a thing that hides another is so much nearer
constexpr double kLeastDistance_m = 0.5;

int rowOf(double elevation_rad) {
  return static_cast<int>(std::floor((elevation_rad - kLowest_rad) / kRow_rad));
}
int columnOf(double azimuth_rad) {
  const int column = static_cast<int>(std::floor(azimuth_rad / kColumn_rad)) % kColumns;
  return column < 0 ? column + kColumns : column;
}

}  // namespace

RangeView::RangeView(const BatchedSweep& sweep) : stamp_(sweep.stamp) {
  if (sweep.batches.empty()) return;
  origin_ = sweep.T_map_lidar.translation;
  ranges_.assign(static_cast<std::size_t>(kColumns) * kRows, 0.0F);
  std::vector<Eigen::Matrix<float, 3, 4>> T;  // into axes of map around the lidar: small numbers
  for (const Batch& batch : sweep.batches)
    T.push_back(Pose{batch.T_map_lidar.rotation, batch.T_map_lidar.translation - origin_}.matrix34f());
  const std::size_t points = sweep.sweep->points.size();
  const std::size_t step = (points / kMostPoints) | 1U;
  std::size_t counted = 0;
  forEachPoint(sweep, [&](std::size_t i, const Batch& batch) {
    if (counted++ % step != 0) return;
    const LidarPoint& p = sweep.sweep->points[i];
    const auto& M = T[static_cast<std::size_t>(&batch - sweep.batches.data())];
    const Eigen::Vector3f q = M.leftCols<3>() * Eigen::Vector3f(p.x, p.y, p.z) + M.col(3);
    const float distance = std::hypot(q.x(), q.y());
    if (!(distance > static_cast<float>(kLeastDistance_m))) return;  // NaN ends here
    const int row = rowOf(static_cast<double>(std::atan2(q.z(), distance)));
    if (row < 0 || row >= kRows) return;
    float& cell = ranges_[static_cast<std::size_t>(row * kColumns +
                                                   columnOf(static_cast<double>(std::atan2(q.y(), q.x()))))];
    if (cell == 0.0F || distance < cell) cell = distance;
  });
}

float RangeView::at(int row, int column) const {
  const int wrapped = (column % kColumns + kColumns) % kColumns;
  return ranges_[static_cast<std::size_t>(row * kColumns + wrapped)];
}

RangeView::Window RangeView::windowOf(const Eigen::Vector2d& center, double yaw_rad, double length,
                                      double width, double bottom, double top) const {
  Window window;
  const Eigen::Vector2d to_center = center - origin_.head<2>();
  window.middle_rad = std::atan2(to_center.y(), to_center.x());
  window.nearest_m = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d u(std::cos(yaw_rad), std::sin(yaw_rad)), v(-u.y(), u.x());
  for (const auto& [a, b] : {std::pair<double, double>{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}}) {
    const Eigen::Vector2d corner = to_center + a * length * u + b * width * v;
    const double distance = corner.norm(),
                 angle = wrapAngle(std::atan2(corner.y(), corner.x()) - window.middle_rad);
    window.nearest_m = std::min(window.nearest_m, distance);
    window.farthest_m = std::max(window.farthest_m, distance);
    if (angle >= window.left_rad) {
      window.left_rad = angle;
      window.left_m = distance;
    }
    if (angle <= window.right_rad) {
      window.right_rad = angle;
      window.right_m = distance;
    }
  }
  const double distance = std::max(to_center.norm(), kLeastDistance_m);
  window.low = std::max(0, rowOf(std::atan2(bottom - origin_.z(), distance)) + 1);
  window.high = std::min(kRows - 1, rowOf(std::atan2(top - origin_.z(), distance)) - 1);
  return window;
}

RangeView::Census RangeView::census(const TrackShape& object) const {
  Census census;
  if (empty() || !object.state.mean.allFinite() || !std::isfinite(object.yaw_rad)) return census;
  const double half = 0.5 * object.height_m.value;
  const Window window = windowOf(object.position(), object.yaw_rad, object.length(), object.width(),
                                 object.middle_z_m.value - half + kFoot_m, object.middle_z_m.value + half);
  if (!(window.nearest_m > kLeastDistance_m)) return census;
  const int first = static_cast<int>(std::ceil((window.middle_rad + window.right_rad) / kColumn_rad));
  const int last = static_cast<int>(std::floor((window.middle_rad + window.left_rad) / kColumn_rad)) - 1;
  const int middle = static_cast<int>(std::floor(window.middle_rad / kColumn_rad));
  for (int row = window.low; row <= window.high; ++row) {
    for (int column = std::min(first, middle); column <= std::max(last, middle); ++column) {
      const double r = static_cast<double>(at(row, column));
      if (r == 0.0) {
        ++census.nothing;
      } else if (r < window.nearest_m - kTolerance_m) {
        ++census.hidden;
      } else if (r > window.farthest_m + kTolerance_m) {
        ++census.through;
      } else {
        ++census.there;
      }
    }
  }
  return census;
}

bool RangeView::nearerAt(double azimuth_rad, double distance_m, const Window& window) const {
  const int column = static_cast<int>(std::floor(azimuth_rad / kColumn_rad));
  int nearer = 0, all = 0;
  for (int row = window.low; row <= window.high; ++row) {
    const double r = static_cast<double>(at(row, column));
    if (r == 0.0) continue;
    ++all;
    nearer += r < distance_m - kStep_m ? 1 : 0;
  }
  return 2 * nearer > all;
}

RangeView::Sides RangeView::hiddenSides(const Obstacle& box) const {
  if (empty()) return {};
  const double half = 0.5 * box.size.z();
  Window window = windowOf(box.center.head<2>(), box.yaw_rad, box.size.x(), box.size.y(),
                           box.center.z() - half, box.center.z() + half);
  window.low = std::max(0, window.low - 1);
  window.high = std::min(kRows - 1, window.high + 1);
  const double left = window.middle_rad + window.left_rad, right = window.middle_rad + window.right_rad;
  Sides sides;
  for (const double beside : {0.7 * kColumn_rad, 1.7 * kColumn_rad}) {
    sides.left = sides.left || nearerAt(left + beside, window.left_m, window);
    sides.right = sides.right || nearerAt(right - beside, window.right_m, window);
  }
  return sides;
}

}  // namespace atlas
