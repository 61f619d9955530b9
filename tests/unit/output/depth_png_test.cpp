// SPDX-License-Identifier: MIT
#include "atlas/output/depth_png.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "atlas/output/png.hpp"

namespace atlas {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(DepthPng, W18_unitsAreMetresTimes256AndZeroIsUnknown) {
  const cv::Mat depth = (cv::Mat_<float>(1, 8) << 1.0F, 20.5F, kNan, 0.0F, -3.0F, 255.99F, 256.0F, 1e30F);
  const cv::Mat units = depthTo16Bit(depth);
  ASSERT_EQ(units.type(), CV_16UC1);
  const std::vector<int> expected = {256, 5248, 0, 0, 0, 65533, 0, 0};
  for (int i = 0; i < 8; ++i)
    EXPECT_EQ(units.at<std::uint16_t>(0, i), expected[static_cast<std::size_t>(i)]) << i;
}

TEST(DepthPng, W18_infinityIsUnknown) {
  const cv::Mat depth = (cv::Mat_<float>(1, 1) << std::numeric_limits<float>::infinity());
  EXPECT_EQ(depthTo16Bit(depth).at<std::uint16_t>(0, 0), 0);
}

TEST(DepthPng, readsBackWithinHalfAUnit) {
  cv::Mat depth(50, 70, CV_32FC1);
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 70; ++column) {
      depth.at<float>(row, column) =
          (row + column) % 7 == 0 ? kNan : 0.5F + 0.07F * static_cast<float>(row * 70 + column) / 3;
    }
  }
  const cv::Mat read = cv::imdecode(encodePng(depthTo16Bit(depth)), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.type(), CV_16UC1);
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 70; ++column) {
      const int unit = read.at<std::uint16_t>(row, column);
      if ((row + column) % 7 == 0) {
        EXPECT_EQ(unit, 0);
      } else {
        EXPECT_NEAR(unit / 256.0, depth.at<float>(row, column), 0.5 / 256.0 + 1e-5);
      }
    }
  }
}

TEST(DepthPng, previewIsBrightNearAndBlackWhereUnknown) {
  const cv::Mat depth = (cv::Mat_<float>(1, 5) << 0.01F, 30.0F, 60.0F, 500.0F, kNan);
  const cv::Mat grey = depthPreview(depth, 60.0);
  const std::vector<int> expected = {255, 128, 1, 1, 0};  // far is 1, so that it is not taken for unknown
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(grey.at<std::uint8_t>(0, i), expected[static_cast<std::size_t>(i)]) << i;
}

}  // namespace
}  // namespace atlas
