// SPDX-License-Identifier: MIT
// Road or thing, without a threshold: the hypothesis whose match is better in a window around the pixel, at
// the disparity that was found (Perrollaz, Labayrade, Gallen, Aubert 2007). The window is high, because what
// tells the hypotheses apart is how the disparity changes from row to row.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/stereo/disparity_image.hpp"

namespace atlas {

constexpr int kRoadLanes = 16;        ///< disparities around the road's that its hypothesis is tried at
constexpr int kRoadMiddle = 8;        ///< the lane that has the road's own disparity
constexpr int kLabelReachRows = 7;    ///< of the window, up and down
constexpr int kLabelReachPixels = 4;  ///< to the left and right
/// What is higher above the road, or deeper below it, than this share of the camera's height is no road; and
/// what differs by so much in disparity may be.
constexpr int kRoadShare = 8;    ///< 1 / share
constexpr int kRoadNoise = 128;  ///< 1/256 px

/// Costs of single pixels (at most 16 each), summed over the rows of the window.
class HypothesisWindows {
 public:
  /// `lanes`: disparities of the frontal hypothesis.
  HypothesisWindows(int width, int lanes);

  void clear();
  /// The row that comes into the window, and the one that leaves it (null: none). Costs by [pixel * lanes +
  /// disparity], those of the road by [pixel * kRoadLanes + lane].
  void add(const std::uint8_t* frontal, const std::uint8_t* road);
  void remove(const std::uint8_t* frontal, const std::uint8_t* road);
  /// What each pixel is part of, for the row in the middle; `disparity`: 1/256 px, or kNoDisparity;
  /// `road_px`: the road's disparity in that row.
  void label(const std::int32_t* disparity, double road_px, std::uint8_t* surface) const;

 private:
  int width_, lanes_;
  std::vector<std::uint8_t> frontal_, road_;
};

}  // namespace atlas
