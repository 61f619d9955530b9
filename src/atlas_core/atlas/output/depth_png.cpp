// SPDX-License-Identifier: MIT
#include "atlas/output/depth_png.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {
constexpr float kUnitsPerMetre = 256.0F;
constexpr float kLargestUnit = 65535.0F;
}  // namespace

ATLAS_AVX2_CLONES
cv::Mat depthTo16Bit(const cv::Mat& depth_m) {
  cv::Mat units(depth_m.rows, depth_m.cols, CV_16UC1, cv::Scalar(0));
  for (int row = 0; row < depth_m.rows; ++row) {
    const float* depth = depth_m.ptr<float>(row);
    std::uint16_t* unit = units.ptr<std::uint16_t>(row);
    for (int column = 0; column < depth_m.cols; ++column) {
      const float value = depth[column] * kUnitsPerMetre + 0.5F;  // truncation rounds it to the nearest
      const float known = value >= 1.0F && value < kLargestUnit + 1.0F ? value : 0.0F;  // NaN is not
      unit[column] = static_cast<std::uint16_t>(static_cast<std::int32_t>(known));
    }
  }
  return units;
}

cv::Mat depthPreview(const cv::Mat& depth_m, double max_depth_m) {
  cv::Mat grey(depth_m.rows, depth_m.cols, CV_8UC1, cv::Scalar(0));
  const auto scale = static_cast<float>(254.0 / max_depth_m);
  for (int row = 0; row < depth_m.rows; ++row) {
    const float* depth = depth_m.ptr<float>(row);
    for (int column = 0; column < depth_m.cols; ++column) {
      if (!(depth[column] > 0.0F)) continue;
      const float value = std::max(1.0F, 255.0F - scale * depth[column]);
      grey.ptr<std::uint8_t>(row)[column] = static_cast<std::uint8_t>(value + 0.5F);
    }
  }
  return grey;
}

}  // namespace atlas
