// SPDX-License-Identifier: MIT
// The right image as it would be if the road had no disparity: each row is shifted by what the road has
// there. A window on the road, in which the disparity changes from row to row, is then matched at one shift,
// as a window on a wall is in the image as it was: the second hypothesis of the double correlation costs no
// more than the first (Perrollaz, Labayrade, Gallen, Aubert 2007).
#pragma once

#include <opencv2/core/mat.hpp>

#include "atlas/stereo/disparity_image.hpp"

namespace atlas {

/// `right`: CV_8UC1. Pixel (u, v) of the result is pixel (u - road.disparityAt(v), v) of `right`, linear
/// between pixels; rows at or above the horizon stay as they are.
cv::Mat shearedByRoad(const cv::Mat& right, const RoadProfile& road);

/// The same road in an image of half the size (see halved()).
RoadProfile halved(const RoadProfile& road);

}  // namespace atlas
