// SPDX-License-Identifier: MIT
// What a camera cannot see although a lidar has measured it. A lidar looks from another place and its lines
// are far apart, so points of a far surface shine through a near one, and a moved object leaves points where
// it was. Both are found in the image, as in Pintus, Gobbetti and Agus 2011, "Real-time rendering of massive
// unstructured raw point clouds using screen-space operators": a point is hidden when nearer ones lie around
// it; here, on two opposite sides within the distance of two scan lines. Neighbours are looked for in a
// coarse image of smallest (and largest) depths, so the order of the points has no influence.
#pragma once

#include <limits>
#include <opencv2/core/mat.hpp>

#include "atlas/camera/pixel_set.hpp"

namespace atlas {

/// Depth of a pixel that no point falls on. Also what cv::erode takes for pixels outside the image; infinity
/// would become this at the border.
constexpr float kNoDepth = std::numeric_limits<float>::max();

struct VisibilityParams {
  double line_gap_px = 14.0;     ///< largest distance of two scan lines in the image
  double relative_step = 0.05;   ///< a surface that is farther by this share of the depth ...
  double absolute_step_m = 0.2;  ///< ... plus this is another one
};

/// An image of z-depths of which few pixels are known.
struct SparseDepth {
  SparseDepth(int width, int height)
      : depth(height, width, CV_32FC1, cv::Scalar(kNoDepth)), pixels(width, height) {}
  cv::Mat depth;    ///< CV_32FC1, m; kNoDepth where nothing is
  PixelSet pixels;  ///< those with a depth
};

/// Removes what is hidden behind nearer points of the same image.
void removeHidden(SparseDepth& image, const VisibilityParams& params);

/// Removes from `older` what `recent` contradicts: next to it there are recent points above or below, and
/// its depth is not among theirs, so it has moved away or something has moved in front of it.
void removeOutdated(SparseDepth& older, const SparseDepth& recent, const VisibilityParams& params);

}  // namespace atlas
