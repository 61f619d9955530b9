// SPDX-License-Identifier: MIT
#include "atlas/camera/depth_buffer.hpp"

#include <opencv2/core.hpp>

namespace atlas {

void DepthBuffer::join() {
  if (!older_.empty()) cv::min(recent_, older_, recent_);
  older_.release();
}

void DepthBuffer::removeInvisible(const VisibilityParams& params) {
  if (!older_.empty()) removeOutdated(older_, recent_, params);
  join();
  removeHidden(recent_, params);
}

cv::Mat DepthBuffer::fill(const GapFillingParams& params) {
  join();
  return fillGaps(recent_, params);
}

cv::Mat DepthBuffer::image() const {
  cv::Mat depth = older_.empty() ? recent_.clone() : cv::Mat();
  if (!older_.empty()) cv::min(recent_, older_, depth);
  for (int row = 0; row < depth.rows; ++row) {
    float* pixels = depth.ptr<float>(row);
    for (int column = 0; column < depth.cols; ++column) {
      if (pixels[column] == kNoDepth) pixels[column] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return depth;
}

}  // namespace atlas
