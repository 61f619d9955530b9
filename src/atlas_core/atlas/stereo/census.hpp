// SPDX-License-Identifier: MIT
// What is compared when a pixel of the left image is looked for in the right one: not its brightness, which
// two cameras see differently, but which of 16 neighbours are darker than it (census transform, Zabih and
// Woodfill 1994). The cost of a match is the number of neighbours that disagree, 0..16.
#pragma once

#include <opencv2/core/mat.hpp>

namespace atlas {

constexpr int kCensusBits = 16;

/// One bit for each neighbour, in two planes of the image's size (CV_8UC1).
struct CensusImage {
  cv::Mat low, high;
};
/// `grey`: CV_8UC1, not empty. Beyond its border the image goes on as it is at the border.
CensusImage censusOf(const cv::Mat& grey);

/// Half the width and height (rounded up): each pixel is the mean of four.
cv::Mat halved(const cv::Mat& grey);

}  // namespace atlas
