// SPDX-License-Identifier: MIT
#include "atlas/camera/depth_buffer.hpp"

#include <algorithm>
#include <limits>

namespace atlas {

void DepthBuffer::join() {
  older_.pixels.forEach([&](int row, int column) {
    float &older = older_.depth.ptr<float>(row)[column], &recent = recent_.depth.ptr<float>(row)[column];
    recent = std::min(recent, older);
    older = kNoDepth;
  });
  recent_.pixels.add(older_.pixels);
  older_.pixels.clear();
}

void DepthBuffer::removeInvisible(const VisibilityParams& params) {
  removeOutdated(older_, recent_, params);
  join();
  removeHidden(recent_, params);
}

DepthBuffer::Images DepthBuffer::takeFilled(const GapFillingParams& params) {
  join();
  Images images;
  images.depth = image();
  images.confidence = pool_.take(size(), 0.0F);
  fillGaps(images.depth, images.confidence, recent_.pixels, params);
  recent_.pixels.forEach([&](int row, int column) { recent_.depth.ptr<float>(row)[column] = kNoDepth; });
  recent_.pixels.clear();
  return images;
}

cv::Mat DepthBuffer::image() {
  cv::Mat depth = pool_.take(size(), std::numeric_limits<float>::quiet_NaN());
  older_.pixels.forEach(
      [&](int row, int column) { depth.ptr<float>(row)[column] = older_.depth.ptr<float>(row)[column]; });
  recent_.pixels.forEach([&](int row, int column) {
    depth.ptr<float>(row)[column] =
        std::min(recent_.depth.ptr<float>(row)[column], older_.depth.ptr<float>(row)[column]);
  });
  return depth;
}

}  // namespace atlas
