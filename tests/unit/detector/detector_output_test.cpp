// SPDX-License-Identifier: MIT
#include "atlas/camera/detector_output.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace atlas {
namespace {

/// 1 x 40 x 7 (v5, two classes) with these rows first, the others empty.
cv::Mat table(const std::vector<std::vector<float>>& rows) {
  const std::array<int, 3> shape = {1, 40, 7};
  cv::Mat output(3, shape.data(), CV_32F, cv::Scalar(0));
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy(rows[i].begin(), rows[i].end(), output.ptr<float>() + 7 * i);
  return output;
}

TEST(NetworkInput, wideImageIsCentredBetweenGreyBars) {
  const cv::Mat image(240, 480, CV_8UC3, cv::Scalar(255, 0, 51));  // blue 1, red 0.2
  const cv::Mat input = networkInput(image, 64);
  ASSERT_EQ(input.dims, 4);
  const float* red = input.ptr<float>();
  const float* blue = red + 2 * 64 * 64;
  EXPECT_FLOAT_EQ(red[15 * 64 + 32], 114.0F / 255.0F);
  EXPECT_FLOAT_EQ(red[16 * 64], 0.2F);
  EXPECT_FLOAT_EQ(blue[16 * 64], 1.0F);
  EXPECT_FLOAT_EQ(red[47 * 64 + 63], 0.2F);
  EXPECT_FLOAT_EQ(red[48 * 64 + 63], 114.0F / 255.0F);
}

TEST(DetectionsOf, backToPixelsOfTheImage) {
  const auto boxes = detectionsOf(table({{32, 24, 16, 8, 0.8F, 0.1F, 0.5F}}), {1280, 640}, 64, {});
  ASSERT_EQ(boxes.size(), 1U);  // scale 1/20, 16 rows of bar above
  EXPECT_NEAR(boxes[0].x_min, 479.5, 1e-3);
  EXPECT_NEAR(boxes[0].x_max, 799.5, 1e-3);
  EXPECT_NEAR(boxes[0].y_min, 79.5, 1e-3);
  EXPECT_NEAR(boxes[0].y_max, 239.5, 1e-3);
  EXPECT_EQ(boxes[0].class_id, 1);
  EXPECT_NEAR(boxes[0].confidence, 0.4, 1e-6);
}

TEST(DetectionsOf, theWeakerOfAClassGoesOtherClassesStay) {
  const auto boxes = detectionsOf(table({{30, 30, 20, 20, 1, 0.6F, 0},
                                         {31, 30, 20, 20, 1, 0.9F, 0},    // the same object, surer
                                         {30, 31, 20, 20, 1, 0, 0.7F},    // another class at the place
                                         {50, 50, 10, 10, 1, 0.3F, 0},    // another place
                                         {10, 10, 10, 10, 1, 0.2F, 0}}),  // not sure enough
                                  {64, 64}, 64, {});
  ASSERT_EQ(boxes.size(), 3U);
  EXPECT_NEAR(boxes[0].confidence, 0.9, 1e-6);
  EXPECT_EQ(boxes[1].class_id, 1);
  EXPECT_NEAR(boxes[2].confidence, 0.3, 1e-6);
  DetectionLimits limits;
  limits.most = 1;
  EXPECT_EQ(
      detectionsOf(table({{30, 30, 20, 20, 1, 0.6F, 0}, {50, 50, 9, 9, 1, 0.6F, 0}}), {64, 64}, 64, limits)
          .size(),
      1U);
}

TEST(DetectionsOf, orderOfRowsHasNoInfluence) {
  std::vector<std::vector<float>> rows;
  for (int i = 0; i < 20; ++i)
    rows.push_back({10.0F + static_cast<float>(i % 5) * 10.0F, 20, 12, 12, 1, 0.5F, 0});
  const auto forwards = detectionsOf(table(rows), {64, 64}, 64, {});
  const std::vector<std::vector<float>> reversed(rows.rbegin(), rows.rend());
  const auto backwards = detectionsOf(table(reversed), {64, 64}, 64, {});
  ASSERT_EQ(forwards.size(), 5U);
  ASSERT_EQ(backwards.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(forwards[i].x_min, backwards[i].x_min);
}

TEST(DetectionsOf, whatIsNoBoxIsNone) {
  const float nan = std::nanf("");
  EXPECT_TRUE(detectionsOf(table({{nan, 20, 12, 12, 1, 0.9F, 0},
                                  {20, 20, -1, 12, 1, 0.9F, 0},
                                  {20, 20, 9, 9, nan, 0.9F, 0},
                                  {20, 20, 9, 9, 1, nan, nan}}),
                           {64, 64}, 64, {})
                  .empty());
}

TEST(DetectionsOf, refusesOtherShapes) {
  const std::array<int, 3> batch = {2, 40, 7}, narrow = {1, 40, 4};
  EXPECT_THROW(detectionsOf(cv::Mat(3, batch.data(), CV_32F), {64, 64}, 64, {}), std::runtime_error);
  EXPECT_THROW(detectionsOf(cv::Mat(3, narrow.data(), CV_32F), {64, 64}, 64, {}), std::runtime_error);
  EXPECT_THROW(detectionsOf(table({}), {64, 64}, 64, {}, 80), std::runtime_error);
  EXPECT_NO_THROW(detectionsOf(table({}), {64, 64}, 64, {}, 2));
  EXPECT_THROW(detectionsOf(cv::Mat(), {64, 64}, 64, {}), std::runtime_error);
  DetectionLimits limits;
  limits.confidence = 0.0;
  EXPECT_THROW(validate(limits), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
