// SPDX-License-Identifier: MIT
#include "atlas/output/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stdexcept>

namespace atlas {
namespace {

cv::Mat frame(int grey) { return {512, 640, CV_8UC1, cv::Scalar(grey)}; }
/// Grey of the middle of tile i: which frame it shows.
int shown(const cv::Mat& sheet, int i, int columns, int rows) {
  return sheet.at<cv::Vec3b>((2 * (i / columns) + 1) * sheet.rows / (2 * rows),
                             (2 * (i % columns) + 1) * sheet.cols / (2 * columns))[0];
}

TEST(ContactSheet, sameSeedSameSheetOtherSeedOtherFrames) {
  const auto drawn = [](std::uint64_t seed) {
    ContactSheet sheet(4, seed);
    for (int i = 0; i < 200; ++i) sheet.offer(frame(i), {}, "");
    return sheet.draw();
  };
  const cv::Mat first = drawn(1);
  EXPECT_EQ(cv::norm(first, drawn(1), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(first, drawn(2), cv::NORM_INF), 0.0);
  for (int i = 1; i < 4; ++i)
    EXPECT_LT(shown(first, i - 1, 2, 2), shown(first, i, 2, 2)) << "in order of time";
}

// 400 sheets of 1 frame out of 10: each frame is expected 40 times with a standard deviation of 6.
TEST(ContactSheet, everyFrameHasTheSameChance) {
  std::array<int, 10> times{};
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    ContactSheet sheet(1, seed);
    for (int i = 0; i < 10; ++i) sheet.offer(cv::Mat(8, 10, CV_8UC1, cv::Scalar(20 * i)), {}, "");
    ++times[static_cast<std::size_t>(shown(sheet.draw(), 0, 1, 1) / 20)];
  }
  for (const int count : times) EXPECT_NEAR(count, 40, 5 * 6.0);
}

TEST(ContactSheet, boxesAreDrawnWhereTheyAre) {
  ContactSheet sheet(1, 1);
  Detections labels;
  labels.boxes = {{160, 128, 480, 384, 2, 0.9}};  // middle half of 640 x 512
  sheet.offer(frame(0), labels, "");
  const cv::Mat picture = sheet.draw();  // 400 x 320 below a caption of 18 rows
  ASSERT_EQ(picture.size(), cv::Size(400, 338));
  EXPECT_NE(picture.at<cv::Vec3b>(18 + 160, 100), cv::Vec3b(0, 0, 0));
  EXPECT_NE(picture.at<cv::Vec3b>(18 + 240, 200), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(picture.at<cv::Vec3b>(18 + 160, 200), cv::Vec3b(0, 0, 0));
}

TEST(ContactSheet, whatCannotBeShown) {
  ContactSheet sheet(4, 1);
  sheet.offer(cv::Mat(), {}, "");
  sheet.offer(cv::Mat(4, 4, CV_16UC1, cv::Scalar(1)), {}, "");
  EXPECT_TRUE(sheet.draw().empty());
  sheet.offer(cv::Mat(900, 3, CV_8UC3, cv::Scalar(1, 1, 1)), {}, "narrow");  // another shape than the rest
  sheet.offer(frame(9), {}, "");
  EXPECT_FALSE(sheet.draw().empty());
  EXPECT_THROW(ContactSheet(0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
