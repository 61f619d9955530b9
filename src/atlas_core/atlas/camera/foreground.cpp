// SPDX-License-Identifier: MIT
#include "atlas/camera/foreground.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace atlas {
namespace {

constexpr double kWeightSigma = 0.25;   // of the box's side
constexpr double kRangeNoise_m = 0.02;  // HDL-32E data sheet

constexpr double kSpacing = 0.15;          // of the quantiles that the density at the front is taken from
constexpr std::size_t kEnoughRecent = 12;  // points in a box that make older ones unnecessary

struct Range {
  std::size_t first = 0, end = 0;
};

/// The window of depths that holds most weight; of equal ones the nearest. `points` sorted by depth.
Range modeOf(const Detection2d& box, const std::vector<BoxPoint>& points, const ForegroundParams& params) {
  const double cu = 0.5 * (box.x_min + box.x_max), cv = 0.5 * (box.y_min + box.y_max);
  const double su = kWeightSigma * (box.x_max - box.x_min), sv = kWeightSigma * (box.y_max - box.y_min);
  std::vector<double> sums(points.size() + 1, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double du = (points[i].u - cu) / su, dv = (points[i].v - cv) / sv;
    sums[i + 1] = sums[i] + std::exp(-0.5 * (du * du + dv * dv));
  }
  Range best;
  double most = -1.0;
  std::size_t end = 0;
  for (std::size_t first = 0; first < points.size(); ++first) {
    const double z = static_cast<double>(points[first].depth_m);
    const double limit = z + params.mode_width_m + params.mode_width_share * z;
    while (end < points.size() && static_cast<double>(points[end].depth_m) <= limit) ++end;
    if (sums[end] - sums[first] > most) {
      most = sums[end] - sums[first];
      best = {first, end};
    }
  }
  return best;
}

/// The mode and all that hangs together with it in depth.
Range grown(Range range, const std::vector<BoxPoint>& points, const ForegroundParams& params) {
  const auto joined = [&](std::size_t nearer) {
    const double z = static_cast<double>(points[nearer].depth_m);
    return static_cast<double>(points[nearer + 1].depth_m) - z <= params.gap_m + params.gap_share * z;
  };
  while (range.first > 0 && joined(range.first - 1)) --range.first;
  while (range.end < points.size() && joined(range.end - 1)) ++range.end;
  return range;
}

/// What moves is only where it was seen at about the time of the image.
void keepRecent(std::vector<BoxPoint>& points, const ForegroundParams& params) {
  const auto is_old = [&](const BoxPoint& p) {
    return std::abs(p.time_s) > static_cast<float>(params.recent_s);
  };
  const auto recent =
      points.size() - static_cast<std::size_t>(std::count_if(points.begin(), points.end(), is_old));
  if (recent < kEnoughRecent) return;
  points.erase(std::remove_if(points.begin(), points.end(), is_old), points.end());
}

}  // namespace

Outcome<Foreground> findForeground(const Detection2d& box, std::vector<BoxPoint>& points,
                                   const ForegroundParams& params) {
  if (points.empty()) return Reason::kNoPoints;
  keepRecent(points, params);
  std::sort(points.begin(), points.end(), [](const BoxPoint& a, const BoxPoint& b) {
    return std::tie(a.depth_m, a.u, a.v, a.time_s) < std::tie(b.depth_m, b.u, b.v, b.time_s);
  });
  const Range mode = modeOf(box, points, params);
  const Range all = grown(mode, points, params);
  const std::size_t count = all.end - all.first;
  if (count < static_cast<std::size_t>(params.min_points)) return Reason::kLowQuality;
  Foreground result;
  result.points = count;
  const auto at = [&](double quantile) {
    return static_cast<double>(
        points[all.first + static_cast<std::size_t>(quantile * static_cast<double>(count - 1))].depth_m);
  };
  result.front_m = at(params.front_quantile);
  result.back_m = at(1.0 - params.front_quantile);
  // sigma of a quantile q: sqrt(q (1 - q) / n) / density, the density from the spacing of two quantiles.
  const double q = params.front_quantile;
  const double spacing = (at(std::min(1.0, q + kSpacing)) - result.front_m) / kSpacing;
  const double sampling = spacing * std::sqrt(q * (1.0 - q) / static_cast<double>(count));
  result.sigma_m = std::sqrt(sampling * sampling + kRangeNoise_m * kRangeNoise_m);
  return result;
}

}  // namespace atlas
