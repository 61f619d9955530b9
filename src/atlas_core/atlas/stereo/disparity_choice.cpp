// SPDX-License-Identifier: MIT
#include "atlas/stereo/disparity_choice.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "atlas/base/avx2_clones.hpp"
#include "atlas/stereo/disparity_image.hpp"

namespace atlas {
namespace {

constexpr std::uint16_t kNever = 0xFFFF;

/// All bits or none: a choice that compilers turn into vector instructions.
constexpr std::uint16_t neverIf(bool condition) {
  return static_cast<std::uint16_t>(-static_cast<int>(condition));
}

/// Of one row of pixels.
struct BestMatches {
  std::uint16_t *best, *cost,
      *second;  ///< by pixel of the left image: disparity, its cost, the next best one's
  std::uint16_t *right_best, *right_cost;  ///< by pixel of the right image, from right to left
};

/// The pixel x of the left image at disparity d is the pixel x - d of the right one, so counted from the
/// right the costs of a pixel go to places one after the other.
template <int Lanes>
ATLAS_AVX2_CLONES void findBest(const std::uint16_t* costs, int width, const BestMatches& matches) {
  const BestMatches m = matches;
  for (int x = 0; x < width; ++x) {
    const std::uint16_t* __restrict cost = costs + static_cast<std::ptrdiff_t>(x) * Lanes;
    std::uint16_t least = kNever;
    for (int d = 0; d < Lanes; ++d) least = cost[d] < least ? cost[d] : least;
    std::uint16_t best = kNever;
    for (std::uint16_t d = 0; d < Lanes; ++d) {
      const std::uint16_t here = static_cast<std::uint16_t>(d | neverIf(cost[d] != least));
      best = here < best ? here : best;
    }
    std::uint16_t second = kNever;  // of the disparities that are not next to the best one
    const std::uint16_t before = static_cast<std::uint16_t>(best - 1);
    for (std::uint16_t d = 0; d < Lanes; ++d) {
      const std::uint16_t away = static_cast<std::uint16_t>(d - before);
      const std::uint16_t here = static_cast<std::uint16_t>(cost[d] | neverIf(away <= 2));
      second = here < second ? here : second;
    }
    m.best[x] = best;
    m.cost[x] = least;
    m.second[x] = second;
    std::uint16_t* __restrict right_cost = m.right_cost + (width - 1 - x);
    std::uint16_t* __restrict right_best = m.right_best + (width - 1 - x);
    for (std::uint16_t d = 0; d < Lanes; ++d) {
      right_best[d] = cost[d] < right_cost[d] ? d : right_best[d];
      right_cost[d] = cost[d] < right_cost[d] ? cost[d] : right_cost[d];
    }
  }
}

/// Where between its neighbours a minimum lies, 1/256 px: two straight lines of the same slope through them.
std::int32_t offsetOfMinimum(int before, int least, int after) {
  const int steeper = std::max(before, after) - least;
  return steeper == 0 ? 0 : (before - after) * (kDisparityScale / 2) / steeper;
}

}  // namespace

void validate(const ChoiceParams& params) {
  const auto check = [](const std::string& field, int value, int most) {
    if (value < 0 || value > most)
      throw std::invalid_argument("disparity choice: " + field + " must be in 0.." + std::to_string(most) +
                                  ", got " + std::to_string(value));
  };
  check("uniqueness_percent", params.uniqueness_percent, 100);
  check("max_left_right_px", params.max_left_right_px, 256);
}

DisparityChoice::DisparityChoice(int width, const ChoiceLanes& lanes, const ChoiceParams& params)
    : width_(width),
      lanes_(lanes.count),
      offset_(lanes.of_zero),
      range_lanes_(lanes.allowed),
      params_(params) {
  best_.resize(static_cast<std::size_t>(width));
  best_cost_.resize(best_.size());
  second_cost_.resize(best_.size());
  right_best_.resize(best_.size() + static_cast<std::size_t>(lanes_));
  right_cost_.resize(right_best_.size());
  chosen_.resize(best_.size());
}

const std::vector<std::int32_t>& DisparityChoice::choose(const std::uint16_t* costs) {
  switch (lanes_) {
    case 32:
      chooseOf<32>(costs);
      break;
    case 64:
      chooseOf<64>(costs);
      break;
    case 128:
      chooseOf<128>(costs);
      break;
    case 256:
      chooseOf<256>(costs);
      break;
    default:
      throw std::invalid_argument("disparity choice: lanes must be 32, 64, 128 or 256, got " +
                                  std::to_string(lanes_));
  }
  return chosen_;
}

template <int Lanes>
void DisparityChoice::chooseOf(const std::uint16_t* costs) {
  std::fill(right_cost_.begin(), right_cost_.end(), kNever);
  std::fill(right_best_.begin(), right_best_.end(), kNever);
  findBest<Lanes>(
      costs, width_,
      {best_.data(), best_cost_.data(), second_cost_.data(), right_best_.data(), right_cost_.data()});
  for (int x = 0; x < width_; ++x) {
    const std::size_t at = static_cast<std::size_t>(x);
    const int best = best_[at], least = best_cost_[at];
    chosen_[at] = kNoChoice;
    if (best - offset_ > x || best >= range_lanes_) continue;  // outside the right image
    const int back = right_best_[static_cast<std::size_t>(width_ - 1 - x + best)];
    if (std::abs(back - best) > params_.max_left_right_px) continue;
    if (second_cost_[at] * 100 <= least * (100 + params_.uniqueness_percent)) continue;
    const std::uint16_t* cost = costs + static_cast<std::ptrdiff_t>(x) * Lanes;
    chosen_[at] = (best - offset_) * kDisparityScale;
    if (best > 0 && best < Lanes - 1) chosen_[at] += offsetOfMinimum(cost[best - 1], least, cost[best + 1]);
  }
}

}  // namespace atlas
