// SPDX-License-Identifier: MIT
// From disparities of the images of half the size to those of the whole ones. First between the pixels, as
// far as they are of one surface; then one step towards the best place of the right image along its rows
// (Lucas and Kanade 1981): with the horizontal gradients l of the left image and r of the right one at the
// disparity d,
//   d' = d - sum(g (l - r)) / sum(g^2),  g = mean slope of l and r,
// over a window that follows the surface. Whole numbers; the quotient is one operation on floats.
#pragma once

#include <opencv2/core/mat.hpp>

namespace atlas {

/// `half`: CV_32SC1, 1/256 px of its own pixels, kNoDisparity where there is none (of an image made by
/// halved()). `full`: CV_32SC1 of the size of that image, overwritten with 1/256 px of its pixels.
void doubled(const cv::Mat& half, cv::Mat& full);

/// `disparity` in place: see above; `left`, `right`: CV_8UC1 of the same size. A step is at most one pixel.
void refine(const cv::Mat& left, const cv::Mat& right, cv::Mat& disparity);

}  // namespace atlas
