// SPDX-License-Identifier: MIT
#include "atlas/output/png.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace atlas {
namespace {

cv::Mat randomImage(int rows, int cols, int type, double largest) {
  cv::RNG random(7);
  cv::Mat image(rows, cols, type);
  random.fill(image, cv::RNG::UNIFORM, 0.0, largest);
  return image;
}

void expectSame(const cv::Mat& image) {
  const cv::Mat before = image.clone();
  const cv::Mat read = cv::imdecode(encodePng(image), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(cv::norm(image, before, cv::NORM_INF), 0.0) << "the caller's pixels";
  ASSERT_EQ(read.type(), image.type());
  ASSERT_EQ(read.size(), image.size());
  EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0.0);
}

TEST(Png, everyPixelComesBackWhateverTheKind) {
  expectSame(randomImage(37, 53, CV_8UC1, 256.0));
  expectSame(randomImage(37, 53, CV_16UC1, 65536.0));
  expectSame(randomImage(37, 53, CV_8UC3, 256.0));  // blue stays blue
  expectSame(cv::Mat(1, 1, CV_16UC1, cv::Scalar(258)));
}

TEST(Png, aPartOfALargerImageIsWrittenAlone) {
  expectSame(randomImage(40, 60, CV_16UC1, 65536.0)(cv::Rect(7, 3, 31, 20)));
}

TEST(Png, likenessOfRowsMakesItSmall) {
  EXPECT_LT(encodePng(cv::Mat(600, 960, CV_16UC1, cv::Scalar(1234))).size(), 600U * 960U * 2U / 100U);
}

TEST(Png, whatIsNoPictureIsRefused) {
  EXPECT_THROW((void)encodePng(cv::Mat()), std::invalid_argument);
  EXPECT_THROW((void)encodePng(cv::Mat(2, 2, CV_32FC1, cv::Scalar(0))), std::invalid_argument);
  EXPECT_THROW((void)encodePng(cv::Mat(2, 2, CV_16UC3, cv::Scalar(0))), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
