// SPDX-License-Identifier: MIT
// Which disparity a pixel has: the one with the least cost, if it is the least by far enough (uniqueness), if
// the pixel of the right image that it points to points back (left-right check), and how far between two
// disparities the minimum lies.
#pragma once

#include <cstdint>
#include <vector>

namespace atlas {

struct ChoiceParams {
  int uniqueness_percent = 25;  ///< by which the cost of any other disparity must be greater
  int max_left_right_px = 1;    ///< difference between the two views, of the images that are matched
};

/// Of no disparity.
constexpr std::int32_t kNoDisparity = -1;

/// Costs of one row: [pixel * lanes + disparity]. Buffers are kept from row to row.
class DisparityChoice {
 public:
  /// `lanes`: 16, 32, 64, 128 or 256. Disparities from `range_px` on are not chosen.
  DisparityChoice(int width, int lanes, int range_px, const ChoiceParams& params);

  /// Disparity of each pixel in 1/256 px, or kNoDisparity. Valid until the next call.
  const std::vector<std::int32_t>& choose(const std::uint16_t* costs);

 private:
  template <int Lanes>
  void chooseOf(const std::uint16_t* costs);

  int width_, lanes_, range_px_;
  ChoiceParams params_;
  std::vector<std::uint16_t> best_, best_cost_, second_cost_;  ///< by pixel of the left image
  std::vector<std::uint16_t> right_best_, right_cost_;  ///< by pixel of the right image, from right to left
  std::vector<std::int32_t> chosen_;
};

}  // namespace atlas
