// SPDX-License-Identifier: MIT
#include "atlas/stereo/stereo_ground.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {

constexpr int kLargestGrid = 10000;
constexpr unsigned kShareSteps = 512;  // from 0 to 1
constexpr unsigned kStepBits = 5;      // kProbabilityOne / kShareSteps
static_assert(kShareSteps << kStepBits == kProbabilityOne);

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("ground cells: " + field + " must be " + need + ", got " +
                              std::to_string(value));
}

ATLAS_AVX2_CLONES void largest(const std::uint16_t* __restrict bin, int columns,
                               std::uint16_t* __restrict seen) {
  for (int u = 0; u < columns; ++u) seen[u] = bin[u] > seen[u] ? bin[u] : seen[u];
}

/// `ratio` of the way from a bin to the next, as a probability.
ATLAS_AVX2_CLONES void between(const std::uint16_t* __restrict bin, const std::uint16_t* __restrict next,
                               int ratio, int columns, std::uint16_t* __restrict seen) {
  for (int u = 0; u < columns; ++u)
    seen[u] =
        static_cast<std::uint16_t>((bin[u] * (kProbabilityOne - ratio) + next[u] * ratio) / kProbabilityOne);
}

/// Evidence for something (odds above 1) to the power of `share`.
float shared(double probability, double share) {
  if (probability > 0.5) {
    const double odds = std::pow(probability / std::max(1.0 - probability, 1e-6), share);
    probability = odds / (1.0 + odds);
  }
  return static_cast<float>(probability);
}

}  // namespace

void validate(const GroundCells& cells) {
  for (const auto& [field, value] :
       {std::pair{"origin_x_m", cells.origin_x_m}, {"origin_y_m", cells.origin_y_m}}) {
    if (!std::isfinite(value)) reject(field, "finite", value);
  }
  if (!(cells.cell_m > 0.0 && std::isfinite(cells.cell_m))) reject("cell_m", "positive", cells.cell_m);
  for (const auto& [field, value] : {std::pair{"columns", cells.columns}, {"rows", cells.rows}}) {
    if (value < 1 || value > kLargestGrid) reject(field, "in 1..10000", value);
  }
}

StereoGround::StereoGround(const StereoRig& rig, int range_px, const UDisparityParams& params,
                           const GroundCells& cells)
    : rig_(rig), cells_(cells), bins_per_px_(params.bins_per_px), range_bins_(range_px * params.bins_per_px) {
  validate(rig);
  validate(params);
  validate(cells);
  const std::size_t count = static_cast<std::size_t>(cells.columns) * cells.rows;
  slices_.resize(static_cast<std::size_t>(cells.columns));
  share_.resize(slices_.size() * kShareSteps);
  columns_.resize(count);
  occupancy_.assign(count, 0.5F);
  seen_.resize(static_cast<std::size_t>(rig.width_px));
  sums_.resize(seen_.size() + 1);
  for (int column = 0; column < cells.columns; ++column) prepareSlice(column);
}

void StereoGround::prepareSlice(int column) {
  const double middle_m = cells_.origin_x_m + (column + 0.5) * cells_.cell_m;
  const double near_m = middle_m - 0.5 * cells_.cell_m, far_m = middle_m + 0.5 * cells_.cell_m;
  if (middle_m <= 0.0) return;
  Slice& slice = slices_[static_cast<std::size_t>(column)];
  slice.middle_bin = rig_.disparityAt(middle_m) * bins_per_px_ - 0.5;
  if (slice.middle_bin >= range_bins_ - 1) return;  // nearer than the matcher looks
  slice.first_bin = rig_.disparityAt(far_m) * bins_per_px_;
  slice.end_bin = near_m > 0.0 ? rig_.disparityAt(near_m) * bins_per_px_ : range_bins_;
  slice.end_bin = std::min(slice.end_bin, 1.0 * range_bins_);
  const double share = std::min(1.0, slice.end_bin - slice.first_bin);
  for (unsigned step = 0; step < kShareSteps; ++step)
    share_[static_cast<std::size_t>(column) * kShareSteps + step] = shared((step + 0.5) / kShareSteps, share);

  for (int row = 0; row < cells_.rows; ++row) {
    const double y_m = cells_.origin_y_m + (row + 0.5) * cells_.cell_m;
    const double at_px = rig_.u0_px - rig_.focal_px * y_m / middle_m;
    const double half_px = 0.5 * rig_.focal_px * cells_.cell_m / middle_m;
    double first = std::ceil(at_px - half_px), end = std::ceil(at_px + half_px);
    if (first >= end) {  // narrower than a column: the nearest one
      first = std::round(at_px);
      end = first + 1.0;
    }
    first = std::max(first, 0.0);
    end = std::min(end, 1.0 * rig_.width_px);
    if (first < end)
      columns_[static_cast<std::size_t>(column) * cells_.rows + row] = {static_cast<std::int16_t>(first),
                                                                        static_cast<std::int16_t>(end)};
  }
}

void StereoGround::lookAlong(const Slice& slice, const UDisparityGrid& grid) {
  const auto bin = [&](int k) { return grid.occupancy.data() + static_cast<std::size_t>(k) * grid.columns; };
  if (slice.end_bin - slice.first_bin < 1.0) {
    const int k = std::clamp(static_cast<int>(std::floor(slice.middle_bin)), 0, grid.bins - 2);
    const int ratio = static_cast<int>(std::clamp(slice.middle_bin - k, 0.0, 1.0) * kProbabilityOne);
    between(bin(k), bin(k + 1), ratio, grid.columns, seen_.data());
    return;
  }
  std::fill(seen_.begin(), seen_.end(), std::uint16_t{0});
  const int end = static_cast<int>(std::ceil(slice.end_bin));
  for (int k = static_cast<int>(slice.first_bin); k < end; ++k) largest(bin(k), grid.columns, seen_.data());
}

const std::vector<float>& StereoGround::fill(const UDisparityGrid& grid) {
  if (grid.columns != rig_.width_px || grid.bins != range_bins_ || grid.bins_per_px != bins_per_px_)
    throw std::invalid_argument("stereo ground: needs a grid of " + std::to_string(rig_.width_px) + "x" +
                                std::to_string(range_bins_) + " cells, got " + std::to_string(grid.columns) +
                                "x" + std::to_string(grid.bins));
  const std::size_t rows = static_cast<std::size_t>(cells_.rows);
  for (std::size_t column = 0; column < slices_.size(); ++column) {
    if (slices_[column].end_bin <= slices_[column].first_bin) continue;  // stays unknown
    lookAlong(slices_[column], grid);
    for (std::size_t u = 0; u < seen_.size(); ++u) sums_[u + 1] = sums_[u] + seen_[u];
    const float* share = share_.data() + column * kShareSteps;
    for (std::size_t row = 0; row < rows; ++row) {
      const Columns& of = columns_[column * rows + row];
      if (of.end <= of.first) continue;
      const std::uint32_t mean =
          (sums_[static_cast<std::size_t>(of.end)] - sums_[static_cast<std::size_t>(of.first)]) /
          static_cast<std::uint32_t>(of.end - of.first);
      occupancy_[row * slices_.size() + column] = share[std::min(mean >> kStepBits, kShareSteps - 1)];
    }
  }
  return occupancy_;
}

}  // namespace atlas
