// SPDX-License-Identifier: MIT
// Which disparity a pixel has: the one with the least cost, if it is the least by far enough (uniqueness), if
// the pixel of the right image that it points to points back (left-right check), and how far between two
// disparities the minimum lies.
#pragma once

#include <cstdint>
#include <vector>

namespace atlas {

struct ChoiceParams {
  int uniqueness_percent = 50;  ///< by which the cost of any other disparity must be greater
  int max_left_right_px = 1;    ///< difference between the two views, of the images that are matched
};

/// Throws std::invalid_argument that names the field and its value.
void validate(const ChoiceParams& params);

/// Of no disparity.
constexpr std::int32_t kNoDisparity = -1;
/// No lane was chosen.
constexpr std::int32_t kNoChoice = INT32_MIN;

/// What the costs of a pixel belong to: lane k to disparity k - of_zero.
struct ChoiceLanes {
  int count = 64;    ///< 32, 64, 128 or 256
  int of_zero = 0;   ///< the lane of disparity 0
  int allowed = 64;  ///< lanes from here on are not chosen
};

/// Costs of one row: [pixel * lanes + lane]. Buffers are kept from row to row.
class DisparityChoice {
 public:
  DisparityChoice(int width, const ChoiceLanes& lanes, const ChoiceParams& params);

  /// Disparity of each pixel in 1/256 px, or kNoChoice. Valid until the next call.
  const std::vector<std::int32_t>& choose(const std::uint16_t* costs);
  /// Least cost of each pixel of the row that was chosen last.
  [[nodiscard]] const std::vector<std::uint16_t>& costs() const { return best_cost_; }

 private:
  template <int Lanes>
  void chooseOf(const std::uint16_t* costs);

  int width_, lanes_, offset_, range_lanes_;
  ChoiceParams params_;
  std::vector<std::uint16_t> best_, best_cost_, second_cost_;  ///< by pixel of the left image
  std::vector<std::uint16_t> right_best_, right_cost_;  ///< by pixel of the right image, from right to left
  std::vector<std::int32_t> chosen_;
};

}  // namespace atlas
