// SPDX-License-Identifier: MIT
// depth/<camera>/<image index, 6 digits>.png: 16 bit, z-depth x 256, 0 = none (KITTI's convention), and 8-bit
// previews.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

namespace atlas {

class DepthWriter {
 public:
  /// Every preview_period-th image also as depth/<camera>/preview/<index>.png; 0 = none.
  DepthWriter(std::filesystem::path out, int preview_period);
  /// depth_m: CV_32FC1, m, NaN unknown.
  void write(const std::string& camera, std::uint32_t index, const cv::Mat& depth_m);

 private:
  std::filesystem::path out_;
  int preview_period_;
};

}  // namespace atlas
