// SPDX-License-Identifier: MIT
#include "atlas/lidar/range_gate.hpp"

#include <limits>

namespace atlas {
namespace {
double rangeSq(const LidarPoint& p) {
  const double x = p.x, y = p.y, z = p.z;
  return x * x + y * y + z * z;
}
}  // namespace

GatedSweep gateByRange(const SweepPtr& sweep, double min_range_m, double max_range_m) {
  const double min_sq = min_range_m * min_range_m;
  const double max_sq = max_range_m * max_range_m;
  const std::vector<LidarPoint>& points = sweep->points;
  const auto believed = [&](double range_sq) {
    return range_sq > 0.0 && range_sq >= min_sq && range_sq <= max_sq;
  };

  std::shared_ptr<Sweep> copy;  // made at the first point that has to change
  GatedSweep result{sweep, 0};
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double range_sq = rangeSq(points[i]);
    if (believed(range_sq)) continue;
    const LidarPoint& p = points[i];
    if (p.x != p.x && p.y != p.y && p.z != p.z) continue;  // no return already
    if (!copy) copy = std::make_shared<Sweep>(*sweep);
    copy->points[i].x = copy->points[i].y = copy->points[i].z = kNan;
    if (range_sq <= std::numeric_limits<double>::max()) ++result.gated;
  }
  if (copy) result.sweep = copy;
  return result;
}

}  // namespace atlas
