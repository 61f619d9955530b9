// SPDX-License-Identifier: MIT
// Between two points of one surface the image is filled, between two surfaces it is not, so nothing grows
// over its own outline as painted squares do. The inverse of the depth of a plane is linear in the image
// (without distortion), so it is what is interpolated: first along rows, where points of a line are close,
// then along columns, from line to line.
#pragma once

#include <opencv2/core/mat.hpp>

#include "atlas/camera/pixel_set.hpp"

namespace atlas {

struct GapFillingParams {
  double focal_px = 500.0;
  double largest_gap_m = 0.3;    ///< on the surface; so the gap in the image grows as the surface comes near
  double largest_gap_px = 14.0;  ///< not more than this
  double relative_step = 0.12;   ///< two ends whose depths differ by more are not of one surface
};

/// `depth`: CV_32FC1, filled in place; `measured` are its pixels that hold a depth, the others are not read.
/// `confidence`: CV_32FC1, all 0 before; becomes 1 where a point was measured, where a gap was filled
/// between, falling with the distance to the measured points from 1 to 1/2 in the middle of the largest gap,
/// along rows and again along columns.
void fillGaps(cv::Mat& depth, cv::Mat& confidence, const PixelSet& measured, const GapFillingParams& params);

}  // namespace atlas
