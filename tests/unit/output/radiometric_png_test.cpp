// SPDX-License-Identifier: MIT
#include "atlas/output/radiometric_png.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace atlas {
namespace {

cv::Mat greys() { return (cv::Mat_<std::uint8_t>(1, 3) << 0, 51, 255); }

TEST(Radiometric, centikelvinBetweenTheTwoEnds) {
  const auto values = radiometric(greys(), {0, -10.0, 40.0});
  ASSERT_TRUE(values);
  EXPECT_EQ((*values).type(), CV_16UC1);
  EXPECT_EQ((*values).at<std::uint16_t>(0), 26315);  // 263.15 K
  EXPECT_EQ((*values).at<std::uint16_t>(1), 27315);  // a fifth of 50 K above: 0 deg C
  EXPECT_EQ((*values).at<std::uint16_t>(2), 31315);
}

TEST(Radiometric, aViewOfOneTemperatureIsLegal) {
  const auto values = radiometric(greys(), {0, 20.0, 20.0});
  ASSERT_TRUE(values);
  EXPECT_EQ((*values).at<std::uint16_t>(0), (*values).at<std::uint16_t>(2));
}

TEST(Radiometric, whatSixteenBitsDoNotHoldIsUnknownNotClamped) {
  const auto values = radiometric(greys(), {0, 0.0, 500.0});
  ASSERT_TRUE(values);
  EXPECT_EQ((*values).at<std::uint16_t>(1), 37315);
  EXPECT_EQ((*values).at<std::uint16_t>(2), 0);
}

TEST(Radiometric, refusesWhatIsNoTemperature) {
  EXPECT_EQ(radiometric(greys(), {0, 40.0, -10.0}).reason(), Reason::kNotFinite);
  EXPECT_EQ(radiometric(greys(), {0, std::nan(""), 10.0}).reason(), Reason::kNotFinite);
  EXPECT_EQ(radiometric(greys(), {0, -300.0, 10.0}).reason(), Reason::kNotFinite);
  EXPECT_EQ(radiometric(cv::Mat(), {0, 0.0, 10.0}).reason(), Reason::kBadLayout);
  EXPECT_EQ(radiometric(cv::Mat(2, 2, CV_8UC3), {0, 0.0, 10.0}).reason(), Reason::kBadLayout);
}

}  // namespace
}  // namespace atlas
