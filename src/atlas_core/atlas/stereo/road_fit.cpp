// SPDX-License-Identifier: MIT
#include "atlas/stereo/road_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace atlas {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kRowStep = 4;      // rows of the image that make one of the histogram
constexpr int kSampleStep = 2;   // of the pixels that are looked at, in rows and columns
constexpr int kFewestRows = 6;   // of the histogram that a line is fitted to
constexpr int kMostBins = 256;   // of disparity, 1 px
constexpr int kUnderWeight = 4;  // pixels under a line count against it as a quarter of one on it

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("road fit: " + field + " must be " + need + ", got " + std::to_string(value));
}

/// Pixels by row and disparity, with sums up to each bin.
class VDisparity {
 public:
  explicit VDisparity(const cv::Mat& disparity) : rows_((disparity.rows + kRowStep - 1) / kRowStep) {
    sums_.assign(static_cast<std::size_t>(rows_) * (kMostBins + 1), 0);
    for (int v = 0; v < disparity.rows; v += kSampleStep) {
      const std::int32_t* row = disparity.ptr<std::int32_t>(v);
      std::int32_t* counts = sums_.data() + static_cast<std::size_t>(v / kRowStep) * (kMostBins + 1) + 1;
      for (int u = 0; u < disparity.cols; u += kSampleStep)
        if (row[u] >= 0 && row[u] < kMostBins * kDisparityScale) ++counts[row[u] / kDisparityScale];
    }
    for (int row = 0; row < rows_; ++row) {
      std::int32_t* counts = sums_.data() + static_cast<std::size_t>(row) * (kMostBins + 1);
      for (int bin = 0; bin < kMostBins; ++bin) counts[bin + 1] += counts[bin];
    }
  }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] static double middleOf(int row) { return row * kRowStep + 0.5 * (kRowStep - 1); }
  /// Pixels of a row in the bins [first, end).
  [[nodiscard]] int count(int row, int first, int end) const {
    const std::int32_t* sums = sums_.data() + static_cast<std::size_t>(row) * (kMostBins + 1);
    first = std::clamp(first, 0, kMostBins);
    end = std::clamp(end, first, kMostBins);
    return sums[end] - sums[first];
  }
  /// Pixels near a line, in the rows below its horizon.
  [[nodiscard]] int near(const RoadProfile& road) const {
    int sum = 0;
    for (int row = firstBelow(road); row < rows_; ++row) {
      const int bin = static_cast<int>(road.disparityAt(middleOf(row)) + 0.5);
      sum += count(row, bin - 1, bin + 1);
    }
    return sum;
  }
  /// Pixels that would be under the road, where nothing can be.
  [[nodiscard]] int under(const RoadProfile& road) const {
    int sum = 0;
    for (int row = firstBelow(road); row < rows_; ++row)
      sum += count(row, 0, static_cast<int>(road.disparityAt(middleOf(row)) + 0.5) - 2);
    return sum;
  }
  [[nodiscard]] int below(const RoadProfile& road) const {
    int sum = 0;
    for (int row = firstBelow(road); row < rows_; ++row) sum += count(row, 0, kMostBins);
    return sum;
  }
  [[nodiscard]] int firstBelow(const RoadProfile& road) const {
    return std::clamp(static_cast<int>(std::ceil(road.horizon_row / kRowStep)), 0, rows_);
  }

 private:
  int rows_;
  std::vector<std::int32_t> sums_;
};

/// Least squares of d = slope (v - horizon) over the pixels within `inlier_px` of `road`.
std::optional<RoadProfile> fitted(const cv::Mat& disparity, const RoadProfile& road, double inlier_px) {
  double n = 0, sum_v = 0, sum_d = 0, sum_vv = 0, sum_vd = 0;
  int rows = 0;
  for (int v = std::max(0, static_cast<int>(std::ceil(road.horizon_row))); v < disparity.rows;
       v += kSampleStep) {
    const std::int32_t* row = disparity.ptr<std::int32_t>(v);
    const double on_road = road.disparityAt(v) * kDisparityScale, reach = inlier_px * kDisparityScale;
    const int from = static_cast<int>(std::max(0.0, on_road - reach)), to = static_cast<int>(on_road + reach);
    std::int64_t count = 0, sum = 0;
    for (int u = 0; u < disparity.cols; u += kSampleStep) {
      const bool inlier = row[u] >= from && row[u] <= to;
      count += inlier;
      sum += inlier ? row[u] : 0;
    }
    const double weight = static_cast<double>(count), d = static_cast<double>(sum) / kDisparityScale;
    rows += count > 0;
    n += weight;
    sum_v += weight * v;
    sum_d += d;
    sum_vv += weight * v * v;
    sum_vd += d * v;
  }
  const double spread = n * sum_vv - sum_v * sum_v;
  if (rows < kFewestRows || spread <= 0.0) return std::nullopt;
  const double slope = (n * sum_vd - sum_v * sum_d) / spread;
  if (slope <= 0.0) return std::nullopt;
  return RoadProfile{(sum_v - sum_d / slope) / n, slope};
}

/// Bounds of what is looked for.
struct Bounds {
  double first_horizon, last_horizon, min_slope, max_slope;
  [[nodiscard]] bool contain(const RoadProfile& road) const {
    return road.horizon_row >= first_horizon && road.horizon_row <= last_horizon &&
           road.slope_px >= min_slope && road.slope_px <= max_slope;
  }
  /// Where the road of the next image is: a braking car dips by a degree or two.
  [[nodiscard]] Bounds around(const RoadProfile& road) const {
    constexpr double kRows = 24.0, kSlopeShare = 0.2;
    return {std::max(first_horizon, road.horizon_row - kRows),
            std::min(last_horizon, road.horizon_row + kRows),
            std::max(min_slope, road.slope_px * (1.0 - kSlopeShare)),
            std::min(max_slope, road.slope_px * (1.0 + kSlopeShare))};
  }
};

RoadProfile bestLine(const VDisparity& pixels, const Bounds& bounds, int image_rows) {
  RoadProfile best{bounds.first_horizon, bounds.min_slope};
  int most = -1;
  const double bottom = image_rows - 1.0;
  for (double horizon = bounds.first_horizon; horizon <= bounds.last_horizon; horizon += kRowStep) {
    const double from_px = bounds.min_slope * (bottom - horizon),
                 to_px = bounds.max_slope * (bottom - horizon);
    for (double bottom_px = from_px; bottom_px <= to_px; bottom_px += 1.0) {
      const RoadProfile line{horizon, bottom_px / (bottom - horizon)};
      const int score = pixels.near(line) - pixels.under(line) / kUnderWeight;
      if (score <= most) continue;
      most = score;
      best = line;
    }
  }
  return best;
}

std::optional<RoadProfile> fittedWithin(const Bounds& bounds, const VDisparity& pixels,
                                        const cv::Mat& disparity, const RoadFitParams& params) {
  RoadProfile line = bestLine(pixels, bounds, disparity.rows);
  for (const double reach : {2.0 * params.inlier_px, params.inlier_px, params.inlier_px}) {
    const auto better = fitted(disparity, line, reach);
    if (!better || !bounds.contain(*better)) return std::nullopt;
    line = *better;
  }
  const int below = pixels.below(line);
  if (below == 0 || pixels.near(line) < params.min_road_share * below) return std::nullopt;
  return line;
}

}  // namespace

void validate(const RoadFitParams& params) {
  if (!(params.min_height_m > 0.0)) reject("min_height_m", "positive", params.min_height_m);
  if (!(params.max_height_m > params.min_height_m && std::isfinite(params.max_height_m)))
    reject("max_height_m", "above min_height_m", params.max_height_m);
  if (!(params.max_pitch_deg >= 0.0 && params.max_pitch_deg <= 45.0))
    reject("max_pitch_deg", "in [0, 45]", params.max_pitch_deg);
  if (!(params.inlier_px > 0.0 && params.inlier_px <= 10.0))
    reject("inlier_px", "in (0, 10]", params.inlier_px);
  if (!(params.min_road_share > 0.0 && params.min_road_share < 1.0))
    reject("min_road_share", "in (0, 1)", params.min_road_share);
}

std::optional<RoadProfile> fitRoad(const cv::Mat& disparity, const StereoRig& rig,
                                   const RoadFitParams& params, const std::optional<RoadProfile>& prior) {
  const double tilt_px = rig.focal_px * std::tan(params.max_pitch_deg * kDegree);
  const Bounds bounds{rig.v0_px - tilt_px,
                      std::min(rig.v0_px + tilt_px, rig.height_px - 2.0 * kRowStep * kFewestRows),
                      rig.baseline_m / params.max_height_m, rig.baseline_m / params.min_height_m};
  const VDisparity pixels(disparity);
  if (prior && bounds.contain(*prior)) {
    const auto near = fittedWithin(bounds.around(*prior), pixels, disparity, params);
    if (near) return near;
  }
  return fittedWithin(bounds, pixels, disparity, params);
}

RoadProfile roadFromCamera(const StereoRig& rig, double height_m, double pitch_rad) {
  if (!(height_m > 0.0 && std::isfinite(height_m))) reject("height_m", "positive", height_m);
  if (!(std::abs(pitch_rad) < 0.5 * M_PI)) reject("pitch_rad", "in (-pi/2, pi/2)", pitch_rad);
  return {rig.v0_px - rig.focal_px * std::tan(pitch_rad), rig.baseline_m * std::cos(pitch_rad) / height_m};
}

}  // namespace atlas
