// SPDX-License-Identifier: MIT
// Images that are used again once nobody else holds them: to get fresh memory from the system costs more than
// to make a large depth image.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <opencv2/core.hpp>

namespace atlas {

class ImagePool {
 public:
  /// CV_32FC1, every pixel `value`. The caller may hand it on, also to other threads.
  cv::Mat take(const cv::Size& size, float value) {
    auto image = std::find_if(images_.begin(), images_.end(), [&](const cv::Mat& kept) {
      return kept.size() == size && CV_XADD(&kept.u->refcount, 0) == 1;
    });
    if (image == images_.end()) {
      image = images_.begin() + static_cast<std::ptrdiff_t>(oldest_);
      oldest_ = (oldest_ + 1) % images_.size();
      *image = cv::Mat(size, CV_32FC1);
    }
    for (int row = 0; row < size.height; ++row) {
      float* pixels = image->ptr<float>(row);
      std::fill(pixels, pixels + size.width, value);
    }
    return *image;
  }

 private:
  std::array<cv::Mat, 8> images_;  ///< the last ones given, more than anybody waits for
  std::size_t oldest_ = 0;
};

}  // namespace atlas
