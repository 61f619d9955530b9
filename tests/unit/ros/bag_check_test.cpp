// SPDX-License-Identifier: MIT
// The checker finds what was planted, and nothing in clean data.
#include "bag_check.hpp"

#include <gtest/gtest.h>

namespace {

constexpr atlas::Duration kStep = 10 * atlas::kMillisecond;
constexpr atlas::Stamp kBegin = 1'000'000'000'000;

TEST(BagCheck, CleanTopicHasNoProblem) {
  atlas_loader::TopicStatistics statistics;
  for (int i = 0; i < 1000; ++i)
    statistics.add(kBegin + i * kStep, kBegin + i * kStep + 2 * atlas::kMillisecond);
  const auto check = statistics.result("sensor_msgs/Imu");
  EXPECT_EQ(check.messages, 1000U);
  EXPECT_NEAR(check.rate_hz, 100.0, 1e-9);
  EXPECT_NEAR(check.median_delay_s, 0.002, 1e-12);
  EXPECT_TRUE(judgeTopic("/imu/data", check).empty());
}

TEST(BagCheck, FindsGapBackwardsDuplicateAndDelay) {
  atlas_loader::TopicStatistics statistics;
  atlas::Stamp stamp = kBegin;
  for (int i = 0; i < 300; ++i) {
    stamp += 10'000'000;
    if (i == 100) stamp += 3 * atlas::kSecond;                                     // gap
    if (i == 150) statistics.add(stamp - 20'000'000, stamp + 5 * atlas::kSecond);  // back
    statistics.add(stamp, stamp + 5 * atlas::kSecond);
    if (i == 200) statistics.add(stamp, stamp + 5 * atlas::kSecond);  // twice
  }
  const auto check = statistics.result("sensor_msgs/Imu");
  EXPECT_EQ(check.backwards, 1U);
  EXPECT_EQ(check.duplicates, 1U);
  EXPECT_NEAR(check.largest_gap_s, 3.01, 1e-9);
  EXPECT_EQ(judgeTopic("/imu/data", check).size(), 4U);
}

TEST(BagCheck, MemoryIsBounded) {
  atlas_loader::TopicStatistics statistics;
  for (int i = 0; i < 400'000; ++i) statistics.add(kBegin + i * 2'500'000LL, kBegin + i * 2'500'000LL);
  EXPECT_NEAR(statistics.result("x").rate_hz, 400.0, 1e-6);
}

TEST(BagCheck, GravityInWords) {
  EXPECT_EQ(atlas_loader::judgeGravity("/imu", {0.1, 0.2, 9.8}, 9.81), "");
  EXPECT_NE(atlas_loader::judgeGravity("/imu", {0.3, -0.4, -9.55}, 9.6).find("sign inverted"),
            std::string::npos);
  EXPECT_NE(atlas_loader::judgeGravity("/imu", {0.0, 9.8, 0.1}, 9.81).find("rotated"), std::string::npos);
  EXPECT_NE(atlas_loader::judgeGravity("/imu", {0.0, 0.0, 1.0}, 1.0).find("not gravity"), std::string::npos);
}

TEST(BagCheck, UnreadableFileIsNamed) {
  try {
    atlas_loader::checkBag("/nowhere/at_all.bag");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at_all.bag"), std::string::npos);
  }
}

}  // namespace
