// SPDX-License-Identifier: MIT
#include "atlas/stereo/u_disparity.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {

constexpr int kLargestRange_px = 256;

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("u-disparity: " + field + " must be " + need + ", got " +
                              std::to_string(value));
}

/// 1 - exp(-x) for x >= 0 to 1e-5, from operations whose results are the same everywhere: the series of
/// exp(x / 16), to the power of -16.
inline float saturated(float x) {
  const float y = x * (1.0F / 16.0F);
  const float e = 1.0F / (1.0F + y * (1.0F + y * (1.0F / 2 + y * (1.0F / 6 + y * (1.0F / 24)))));
  const float e2 = e * e, e4 = e2 * e2, e8 = e4 * e4;
  return 1.0F - e8 * e8;
}

/// What a bin's cells share.
struct BinFactors {
  float per_possible = 0;    ///< 1 / N_P, 0 without possible rows
  float per_obstacle = 0;    ///< 1 / obstacle_share
  float road_rows = 1;       ///< N_R*
  float per_road_share = 0;  ///< 1 / road_share, 0 where the road is not seen
  float occupied = 0;        ///< 1 - P_fp
  float missed = 0;          ///< P_fn
  int low = 0, high = kProbabilityOne;
};

/// Counts spread over the bins, of one bin: `at` is its row of counts.
ATLAS_AVX2_CLONES void spread(const std::uint16_t* __restrict at, const std::vector<float>& kernel,
                              int columns, float* __restrict sum) {
  for (int u = 0; u < columns; ++u) sum[u] = kernel[0] * static_cast<float>(at[u]);
  for (int k = 1; k < static_cast<int>(kernel.size()); ++k) {
    const float weight = kernel[static_cast<std::size_t>(k)];
    const std::uint16_t *below = at - k * columns, *above = at + k * columns;
    for (int u = 0; u < columns; ++u) sum[u] += weight * static_cast<float>(below[u] + above[u]);
  }
}

/// Equation (1) for the cells of one bin.
ATLAS_AVX2_CLONES void occupancyOfBin(const std::uint16_t* __restrict visible,
                                      const float* __restrict obstacle, const float* __restrict road,
                                      const BinFactors& factors, int columns,
                                      std::uint16_t* __restrict occupancy) {
  const BinFactors f = factors;
  for (int u = 0; u < columns; ++u) {
    const int rows = visible[u];
    const float p_visible = static_cast<float>(rows) * f.per_possible;
    const float p_confident =
        saturated(obstacle[u] * f.per_obstacle / static_cast<float>(rows + (rows == 0)));
    const float p_road = saturated(road[u] * f.per_road_share / (f.road_rows + obstacle[u]));
    const float p_seen = p_confident * f.occupied + (1.0F - p_confident) * f.missed;
    const float p = (p_visible * p_seen + (1.0F - p_visible) * 0.5F) * (1.0F - p_road);
    const int scaled = static_cast<int>(p * static_cast<float>(kProbabilityOne));
    const int at_least = scaled < f.low ? f.low : scaled;
    occupancy[u] = static_cast<std::uint16_t>(at_least > f.high ? f.high : at_least);
  }
}

/// N_V grows bin by bin by the rows that become visible in it.
ATLAS_AVX2_CLONES void addVisible(const std::uint16_t* __restrict obstacle,
                                  const std::uint16_t* __restrict road,
                                  const std::uint16_t* __restrict beyond, int columns,
                                  std::uint16_t* __restrict visible) {
  for (int u = 0; u < columns; ++u)
    visible[u] = static_cast<std::uint16_t>(visible[u] + obstacle[u] + road[u] + beyond[u]);
}

}  // namespace

void validate(const UDisparityParams& params) {
  for (const auto& [field, value] :
       {std::pair{"false_positive", params.false_positive}, {"false_negative", params.false_negative}}) {
    if (!(value >= 0.0 && value < 0.5)) reject(field, "in [0, 0.5)", value);
  }
  for (const auto& [field, value] : {std::pair{"max_height_m", params.max_height_m},
                                     {"obstacle_share", params.obstacle_share},
                                     {"road_share", params.road_share}}) {
    if (!(value > 0.0 && std::isfinite(value))) reject(field, "positive", value);
  }
  if (params.bins_per_px < 1 || params.bins_per_px > 16)
    reject("bins_per_px", "in 1..16", params.bins_per_px);
  if (!(params.disparity_sigma_px >= 0.0 && params.disparity_sigma_px <= 4.0))
    reject("disparity_sigma_px", "in [0, 4]", params.disparity_sigma_px);
  if (!(params.min_probability >= 0.0 && params.min_probability < 0.5))
    reject("min_probability", "in [0, 0.5)", params.min_probability);
  if (!(params.max_probability > 0.5 && params.max_probability <= 1.0))
    reject("max_probability", "in (0.5, 1]", params.max_probability);
}

UDisparity::UDisparity(const StereoRig& rig, int range_px, const UDisparityParams& params)
    : rig_(rig), params_(params) {
  validate(rig);
  validate(params);
  if (range_px < 1 || range_px > kLargestRange_px) reject("range_px", "in 1..256", range_px);
  grid_.columns = rig.width_px;
  grid_.bins_per_px = params.bins_per_px;
  grid_.bins = range_px * params.bins_per_px;
  grid_.occupancy.resize(static_cast<std::size_t>(grid_.columns) * grid_.bins);

  const double sigma_bins = params.disparity_sigma_px * params.bins_per_px;
  const int reach = static_cast<int>(std::ceil(2.5 * sigma_bins));
  double sum = 0;
  std::vector<double> weights;
  for (int k = 0; k <= reach; ++k) {
    weights.push_back(k == 0 ? 1.0 : std::exp(-0.5 * (k / sigma_bins) * (k / sigma_bins)));
    sum += k == 0 ? 1.0 : 2.0 * weights.back();
  }
  for (const double weight : weights) kernel_.push_back(static_cast<float>(weight / sum));
}

/// In row v a thing between the road and max_height_m is seen at disparity d when v lies between the rows of
/// its top and its foot: v_t = v_h + d (1 / slope - max_height_m / baseline) <= v <= v_h + d / slope.
void UDisparity::prepareRows(const RoadProfile& road) {
  const int rows = rig_.height_px, bins = grid_.bins;
  const double bin_px = 1.0 / grid_.bins_per_px;
  const double foot = 1.0 / road.slope_px, top = foot - params_.max_height_m / rig_.baseline_m;
  const auto bin_from = [&](double disparity_px) {  // first bin whose middle is not less
    return static_cast<std::uint16_t>(std::clamp(std::ceil(disparity_px / bin_px - 0.5), 0.0, bins * 1.0));
  };
  const auto bin_up_to = [&](double disparity_px) {  // behind the last one whose middle is not greater
    return static_cast<std::uint16_t>(std::clamp(std::floor(disparity_px / bin_px + 0.5), 0.0, bins * 1.0));
  };
  first_.assign(static_cast<std::size_t>(rows), 0);
  end_.assign(static_cast<std::size_t>(rows), static_cast<std::uint16_t>(bins));
  possible_.assign(static_cast<std::size_t>(bins), 0);
  for (std::size_t v = 0; v < first_.size(); ++v) {
    const double below_horizon = static_cast<double>(v) - road.horizon_row;
    if (below_horizon >= 0.0) {
      first_[v] = bin_from(below_horizon / foot);
      if (top > 0.0) end_[v] = bin_up_to(below_horizon / top);
    } else {
      first_[v] = top < 0.0 ? bin_from(below_horizon / top) : static_cast<std::uint16_t>(bins);
    }
    for (int k = first_[v]; k < end_[v]; ++k) ++possible_[static_cast<std::size_t>(k)];
  }

  std::vector<double> seen(static_cast<std::size_t>(bins));
  for (int k = 0; k < bins; ++k) {
    const double from = std::max(road.horizon_row + k * bin_px * foot, -0.5);
    const double to = std::min(road.horizon_row + (k + 1) * bin_px * foot, rows - 0.5);
    seen[static_cast<std::size_t>(k)] = std::max(0.0, to - from);
  }
  road_rows_.assign(static_cast<std::size_t>(bins), 0.0F);
  const int reach = static_cast<int>(kernel_.size()) - 1;
  for (int k = 0; k < bins; ++k) {
    double sum = 0;
    for (int j = std::max(0, k - reach); j <= std::min(bins - 1, k + reach); ++j)
      sum += kernel_[static_cast<std::size_t>(std::abs(j - k))] * seen[static_cast<std::size_t>(j)];
    road_rows_[static_cast<std::size_t>(k)] = static_cast<float>(sum);
  }
}

/// Each pixel with a disparity counts once: for what it is, at its bin, or, when its row is none of the
/// possible ones there, as visible from the first bin on where it is.
void UDisparity::count(const DisparityImage& image) {
  const std::size_t columns = static_cast<std::size_t>(grid_.columns);
  const std::size_t margin = (kernel_.size() - 1) * columns;
  const unsigned bins = static_cast<unsigned>(grid_.bins),
                 bins_per_px = static_cast<unsigned>(grid_.bins_per_px);
  for (auto* counts : {&obstacle_, &way_, &beyond_}) counts->assign(bins * columns + 2 * margin, 0);
  constexpr std::uint8_t kBeyond = 0, kRoad = static_cast<std::uint8_t>(SurfaceLabel::kRoad);
  std::uint16_t* const planes[] = {beyond_.data() + margin, obstacle_.data() + margin, way_.data() + margin};
  for (int v = 0; v < rig_.height_px; ++v) {
    const std::uint16_t* disparity = image.disparity.ptr<std::uint16_t>(v);
    const std::uint8_t* surface = image.surface.ptr<std::uint8_t>(v);
    const unsigned first = first_[static_cast<std::size_t>(v)], end = end_[static_cast<std::size_t>(v)];
    // road that is measured a little under the road counts at the road
    const std::uint8_t under = v > image.road->horizon_row ? kRoad : kBeyond;
    for (std::size_t u = 0; u < columns; ++u) {
      if (disparity[u] == 0) continue;
      const unsigned measured = disparity[u] * bins_per_px / kDisparityScale;
      const unsigned bin = std::max(measured, first);
      if (bin >= end) continue;
      const std::uint8_t kind = measured < first && surface[u] != under ? kBeyond : surface[u];
      ++planes[kind][bin * columns + u];
      if (end < bins) --planes[kBeyond][end * columns + u];  // modulo 2^16, as the sum of all is taken
    }
  }
}

void UDisparity::evaluate() {
  const std::size_t columns = static_cast<std::size_t>(grid_.columns);
  const std::size_t margin = (kernel_.size() - 1) * columns;
  visible_.assign(columns, 0);
  std::vector<float> obstacle(columns), road(columns);
  BinFactors factors;
  factors.per_obstacle = static_cast<float>(1.0 / params_.obstacle_share);
  factors.occupied = static_cast<float>(1.0 - params_.false_positive);
  factors.missed = static_cast<float>(params_.false_negative);
  factors.low = static_cast<int>(std::lround(params_.min_probability * kProbabilityOne));
  factors.high = static_cast<int>(std::lround(params_.max_probability * kProbabilityOne));
  for (std::size_t k = 0; k < static_cast<std::size_t>(grid_.bins); ++k) {
    const std::size_t at = k * columns;
    const std::uint16_t *obstacles = obstacle_.data() + margin + at, *roads = way_.data() + margin + at;
    addVisible(obstacles, roads, beyond_.data() + margin + at, grid_.columns, visible_.data());
    spread(obstacles, kernel_, grid_.columns, obstacle.data());
    spread(roads, kernel_, grid_.columns, road.data());
    factors.per_possible = possible_[k] == 0 ? 0.0F : 1.0F / static_cast<float>(possible_[k]);
    constexpr float kFewestRows = 1e-3F;  // the road lies below the image
    const bool road_seen = road_rows_[k] >= kFewestRows;
    factors.per_road_share = road_seen ? static_cast<float>(1.0 / params_.road_share) : 0.0F;
    factors.road_rows = road_seen ? road_rows_[k] : 1.0F;
    occupancyOfBin(visible_.data(), obstacle.data(), road.data(), factors, grid_.columns,
                   grid_.occupancy.data() + at);
  }
}

const UDisparityGrid& UDisparity::compute(const DisparityImage& image) {
  const cv::Size size(rig_.width_px, rig_.height_px);
  if (image.disparity.size() != size || image.disparity.type() != CV_16UC1 || image.surface.size() != size ||
      image.surface.type() != CV_8UC1)
    throw std::invalid_argument(
        "u-disparity: disparity (16 bit) and surface (8 bit) must have the size of the rig, " +
        std::to_string(size.width) + "x" + std::to_string(size.height) + ", got " +
        std::to_string(image.disparity.cols) + "x" + std::to_string(image.disparity.rows));
  if (!image.road) throw std::invalid_argument("u-disparity: the road is unknown, so heights above it are");
  if (!(image.road->slope_px > 0.0 && std::isfinite(image.road->slope_px) &&
        std::isfinite(image.road->horizon_row)))
    reject("road slope_px", "positive", image.road->slope_px);
  prepareRows(*image.road);
  count(image);
  evaluate();
  return grid_;
}

}  // namespace atlas
