// SPDX-License-Identifier: MIT
#include "atlas/stereo/road_view.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {

constexpr int kOne = 256;  // of a share of a pixel

/// `pixel` is that of the first column, `ratio` how far towards the one to its left.
ATLAS_AVX2_CLONES void shiftRow(const std::uint8_t* __restrict pixel, int ratio, int width,
                                std::uint8_t* __restrict shifted) {
  for (int x = 0; x < width; ++x)
    shifted[x] =
        static_cast<std::uint8_t>((pixel[x] * (kOne - ratio) + pixel[x - 1] * ratio + kOne / 2) / kOne);
}

}  // namespace

cv::Mat shearedByRoad(const cv::Mat& right, const RoadProfile& road) {
  const int most = static_cast<int>(std::ceil(std::max(0.0, road.disparityAt(right.rows)))) + 1;
  cv::Mat padded, sheared(right.size(), CV_8UC1);
  const int pad = std::min(most, right.cols);
  cv::copyMakeBorder(right, padded, 0, 0, pad, 0, cv::BORDER_REPLICATE);
  for (int v = 0; v < right.rows; ++v) {
    const double shift_px = std::clamp(road.disparityAt(v), 0.0, pad - 1.0);
    const int whole = static_cast<int>(shift_px);
    const int ratio = static_cast<int>((shift_px - whole) * kOne);
    shiftRow(padded.ptr<std::uint8_t>(v) + pad - whole, ratio, right.cols, sheared.ptr<std::uint8_t>(v));
  }
  return sheared;
}

RoadProfile halved(const RoadProfile& road) { return {(road.horizon_row - 0.5) / 2.0, road.slope_px}; }

}  // namespace atlas
