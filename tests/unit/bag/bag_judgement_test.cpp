// SPDX-License-Identifier: MIT
// What is said about topics together: coverage, delays, frames, contents.
#include <gtest/gtest.h>

#include "bag_check.hpp"

namespace atlas_loader {
namespace {

constexpr atlas::Stamp kBegin = 1'568'186'745 * atlas::kSecond;

/// 100 Hz over [begin, end) s, recorded `delay_s` later.
TopicCheck topic(double begin_s, double end_s, double delay_s = 0.0) {
  TopicStatistics statistics;
  for (double t = begin_s; t < end_s; t += 0.01) {
    const atlas::Stamp stamp = kBegin + atlas::fromSeconds(t);
    statistics.add(stamp, stamp + atlas::fromSeconds(delay_s));
  }
  return statistics.result("x");
}

TopicContent content(atlas::StreamKind kind, const std::string& frame = "base_link") {
  TopicContent c;
  c.kind = kind;
  c.frames = {frame};
  return c;
}

/// A bag with everything that a run needs.
struct Bag {
  BagCheck check;
  std::map<std::string, TopicContent> contents = {
      {"/imu/data", content(atlas::StreamKind::kImu)},
      {"/gnss/fix", content(atlas::StreamKind::kGnssFix, "gnss_rear")},
      {"/gnss/heading", content(atlas::StreamKind::kGnssHeading)},
      {"/lidar/points", content(atlas::StreamKind::kPoints, "lidar")},
      {"/camera/camera_info", content(atlas::StreamKind::kCameraInfo, "camera")},
      {"/tf_static", content(atlas::StreamKind::kStaticTransforms)}};
  std::set<std::string> frames = {"base_link", "gnss_rear", "lidar", "camera"};
  Bag() {
    for (const auto& [name, c] : contents) {
      if (name != "/tf_static") check.topics[name] = topic(0, 20);
    }
  }
  void judge() { judgeBag(contents, frames, check); }
  bool problem(const std::string& words) const { return says(check.problems, words); }
  bool remark(const std::string& words) const { return says(check.remarks, words); }
  static bool says(const std::vector<std::string>& lines, const std::string& words) {
    for (const std::string& line : lines) {
      if (line.find(words) != std::string::npos) return true;
    }
    return false;
  }
};

TEST(BagJudgement, GoodBagHasNothing) {
  Bag bag;
  bag.judge();
  EXPECT_TRUE(bag.check.problems.empty()) << bag.check.problems.front();
  EXPECT_TRUE(bag.check.remarks.empty()) << bag.check.remarks.front();
}

TEST(BagJudgement, TopicsThatBeginLateOrEndEarly) {
  Bag bag;
  bag.check.topics["/imu/data"] = topic(3, 20);
  bag.check.topics["/gnss/fix"] = topic(0, 15);
  bag.judge();
  EXPECT_TRUE(bag.problem("topics that begin after the others: /imu/data 3.0 s"));
  EXPECT_TRUE(bag.problem("topics that end before the others: /gnss/fix 5.0 s"));
  EXPECT_EQ(bag.check.problems.size(), 2U);
}

TEST(BagJudgement, DelayOfOneTopicAgainstTheOthersBeyondTheReplaysPatience) {
  Bag bag;
  bag.check.topics["/lidar/points"] = topic(0, 20, 0.9);
  bag.judge();
  EXPECT_TRUE(bag.check.problems.empty());
  bag.check.topics["/lidar/points"] = topic(0, 20, 2.5);
  bag.judge();
  EXPECT_TRUE(bag.problem("/lidar/points: lies up to 2.50 s later in the bag"));
}

TEST(BagJudgement, FrameWithoutAPlace) {
  Bag bag;
  bag.frames.erase("lidar");
  bag.judge();
  EXPECT_TRUE(bag.problem("/lidar/points: frame 'lidar' has no place in /tf_static"));
  EXPECT_EQ(bag.check.problems.size(), 1U);
}

TEST(BagJudgement, UnusableMessagesAndEmptyClouds) {
  Bag bag;
  bag.contents["/gnss/fix"].unusable["not finite"] = 7;
  TopicContent& clouds = bag.contents["/lidar/points"];
  clouds.clouds = 10;
  clouds.empty_clouds = 4;
  clouds.clouds_without_time = 10;
  bag.judge();
  EXPECT_TRUE(bag.problem("/gnss/fix: 7 messages are unusable: not finite"));
  EXPECT_TRUE(bag.problem("/lidar/points: 4 of 10 clouds are empty"));
  EXPECT_TRUE(bag.remark("/lidar/points: 10 of 10 clouds have no time per point"));
}

TEST(BagJudgement, MissingTopicsAndSlowImu) {
  Bag bag;
  bag.contents.erase("/gnss/fix");
  bag.contents.erase("/tf_static");
  bag.contents.erase("/gnss/heading");
  bag.frames.clear();
  for (const char* name : {"/gnss/fix", "/gnss/heading"}) bag.check.topics.erase(name);
  TopicStatistics slow;
  for (int i = 0; i < 200; ++i)
    slow.add(kBegin + i * 100 * atlas::kMillisecond, kBegin + i * 100 * atlas::kMillisecond);
  bag.check.topics["/imu/data"] = slow.result("sensor_msgs/Imu");
  bag.judge();
  EXPECT_TRUE(bag.problem("no GNSS fix"));
  EXPECT_TRUE(bag.problem("no /tf_static"));
  EXPECT_TRUE(bag.remark("no GNSS heading"));
  EXPECT_TRUE(bag.remark("/imu/data: 10.0 Hz is slow for an IMU"));
}

TEST(TopicStatistics, MessagesWithoutStampAreNoTimes) {
  TopicStatistics statistics;
  for (int i = 0; i < 5; ++i) statistics.add(0, kBegin + i);
  const TopicCheck check = statistics.result("x");
  EXPECT_EQ(check.without_stamp, 5U);
  EXPECT_EQ(check.duplicates, 0U);
  EXPECT_EQ(check.last, 0);
  ASSERT_EQ(judgeTopic("/t", check).size(), 1U);
  EXPECT_EQ(judgeTopic("/t", check)[0], "/t: 5 messages have no stamp");
}

TEST(Gravity, NamesTheAxisThatPointsUp) {
  EXPECT_NE(judgeGravity("/imu", {0.1, 9.8, 0.1}, 9.84).find("up is +y"), std::string::npos);
  EXPECT_NE(judgeGravity("/imu", {-9.8, 0.1, 0.1}, 9.84).find("up is -x"), std::string::npos);
  EXPECT_NE(judgeGravity("/imu", {6.9, 0, 6.9}, 9.8).find("mounted rotated"), std::string::npos)
      << "between two axes";
}

}  // namespace
}  // namespace atlas_loader
