// SPDX-License-Identifier: MIT
#include "atlas/stereo/hypothesis_windows.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {

constexpr int kRoadReach = (kRoadMiddle - 2) * kDisparityScale;  // its lanes and the next ones exist

static_assert((2 * kLabelReachRows + 1) * 16 <= 255, "the sum of a column must fit a byte");

ATLAS_AVX2_CLONES void addTo(std::uint8_t* __restrict sums, const std::uint8_t* __restrict costs, int count) {
  for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint8_t>(sums[i] + costs[i]);
}

ATLAS_AVX2_CLONES void takeFrom(std::uint8_t* __restrict sums, const std::uint8_t* __restrict costs,
                                int count) {
  for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint8_t>(sums[i] - costs[i]);
}

}  // namespace

HypothesisWindows::HypothesisWindows(int width, int lanes) : width_(width), lanes_(lanes) {
  frontal_.resize(static_cast<std::size_t>(width) * lanes);
  road_.resize(static_cast<std::size_t>(width) * kRoadLanes);
}

void HypothesisWindows::clear() {
  std::fill(frontal_.begin(), frontal_.end(), std::uint8_t{0});
  std::fill(road_.begin(), road_.end(), std::uint8_t{0});
}

void HypothesisWindows::add(const std::uint8_t* frontal, const std::uint8_t* road) {
  addTo(frontal_.data(), frontal, width_ * lanes_);
  addTo(road_.data(), road, width_ * kRoadLanes);
}

void HypothesisWindows::remove(const std::uint8_t* frontal, const std::uint8_t* road) {
  takeFrom(frontal_.data(), frontal, width_ * lanes_);
  takeFrom(road_.data(), road, width_ * kRoadLanes);
}

void HypothesisWindows::label(const std::int32_t* disparity, double road_px, std::uint8_t* surface) const {
  const int road = static_cast<int>(std::lround(road_px * kDisparityScale));
  for (int x = 0; x < width_; ++x) {
    if (disparity[x] < 0) continue;
    surface[x] = static_cast<std::uint8_t>(SurfaceLabel::kObstacle);
    const int away = std::abs(disparity[x] - road);
    if (away > kRoadNoise + disparity[x] / kRoadShare || away > kRoadReach) continue;
    const int d = std::min((disparity[x] + kDisparityScale / 2) / kDisparityScale, lanes_ - 1);
    // the road's lanes lie between whole disparities: `lane` and the next one, 1/256
    const int place = d * kDisparityScale - road + kRoadMiddle * kDisparityScale;
    const int lane = place / kDisparityScale, ratio = place % kDisparityScale;
    int frontal_sum = 0, road_sum = 0;
    for (int at = std::max(x - kLabelReachPixels, 0); at <= std::min(x + kLabelReachPixels, width_ - 1);
         ++at) {
      const std::uint8_t* of_road = road_.data() + static_cast<std::ptrdiff_t>(at) * kRoadLanes + lane;
      frontal_sum += frontal_[static_cast<std::size_t>(at * lanes_ + d)] * kDisparityScale;
      road_sum += of_road[0] * (kDisparityScale - ratio) + of_road[1] * ratio;
    }
    if (road_sum <= frontal_sum) surface[x] = static_cast<std::uint8_t>(SurfaceLabel::kRoad);
  }
}

}  // namespace atlas
