// SPDX-License-Identifier: MIT
#include "atlas/output/png.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace atlas {
namespace {

/// Smooth in places, noise in others, every value of a byte.
cv::Mat picture(int rows, int columns, int type) {
  cv::RNG random(static_cast<std::uint64_t>(rows * 1000 + columns));
  cv::Mat image(rows, columns, type);
  random.fill(image, cv::RNG::UNIFORM, 0, type == CV_16UC1 ? 65536 : 256);
  image.rowRange(0, rows / 2).setTo(cv::Scalar(700, 20, 3));
  return image;
}
void expectSame(const cv::Mat& image) {
  const cv::Mat read = cv::imdecode(encodePng(image), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.type(), image.type());
  ASSERT_EQ(read.size(), image.size());
  EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0.0) << image.size() << " type " << image.type();
}

TEST(Png, EveryPixelIsReadBack) {
  for (const int type : {CV_8UC1, CV_16UC1, CV_8UC3}) {
    for (const auto& size :
         {cv::Size(1, 1), cv::Size(7, 1), cv::Size(1, 9), cv::Size(13, 6), cv::Size(640, 512)})
      expectSame(picture(size.height, size.width, type));
  }
}

TEST(Png, APartOfAnImage) { expectSame(picture(40, 60, CV_16UC1)(cv::Rect(11, 5, 17, 30))); }

TEST(Png, EmptyImagesAndOtherLayoutsAreRefused) {
  EXPECT_THROW(encodePng(cv::Mat()), std::invalid_argument);
  for (const int type : {CV_32FC1, CV_8UC4, CV_16UC3, CV_16SC1})
    EXPECT_THROW(encodePng(cv::Mat(4, 4, type)), std::invalid_argument) << type;
}

}  // namespace
}  // namespace atlas
