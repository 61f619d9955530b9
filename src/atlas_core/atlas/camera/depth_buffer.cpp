// SPDX-License-Identifier: MIT
#include "atlas/camera/depth_buffer.hpp"

#include <opencv2/imgproc.hpp>

namespace atlas {

cv::Mat DepthBuffer::image(int splat_px) const {
  cv::Mat depth;
  if (splat_px > 0) {
    // The minimum over a square is what painting every point as a square and keeping the nearest gives.
    const int side = 2 * splat_px + 1;
    cv::erode(nearest_, depth, cv::Mat::ones(side, side, CV_8UC1));
  } else {
    depth = nearest_.clone();
  }
  for (int row = 0; row < depth.rows; ++row) {
    float* pixels = depth.ptr<float>(row);
    for (int column = 0; column < depth.cols; ++column) {
      if (pixels[column] == kNothing) pixels[column] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return depth;
}

}  // namespace atlas
