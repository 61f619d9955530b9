// SPDX-License-Identifier: MIT
// A small record through the converter: every message is in the bag, in order, and the checker judges it as
// it should.
#include "record_bag.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "atlas_ros/conversions.hpp"
#include "bag_check.hpp"
#include "record/open_record.hpp"
#include "small_video.hpp"

namespace atlas_loader {
namespace {

using atlas::test::TemporaryFolder;

class RecordBag : public ::testing::Test {
 protected:
  void SetUp() override {
    atlas::test::writeSmallRecord(record_);
    atlas::test::addCameras(record_, 10);
  }
  BagCounts convert(const atlas::RecordOptions& options = {}) {
    reader_ = atlas::openRecord(record_.path(), options);
    return writeBag(*reader_, bag(), [](atlas::Stamp) { return true; });
  }
  [[nodiscard]] std::string bag() const { return (out_ / "drive.bag").string(); }
  TemporaryFolder record_, out_;
  std::unique_ptr<atlas::RecordReader> reader_;
};

TEST_F(RecordBag, HoldsEveryMessageInOrderOfStamps) {
  const BagCounts counts = convert();
  EXPECT_TRUE(counts.complete);
  EXPECT_EQ(counts.messages.at("/imu/data"), 400U);
  EXPECT_EQ(counts.messages.at("/lidar_left/points"), 10U);
  rosbag::Bag file(bag(), rosbag::bagmode::Read);
  rosbag::View view(file);
  std::map<std::string, std::uint64_t> found;
  ros::Time before;
  for (const rosbag::MessageInstance& m : view) {
    ++found[m.getTopic()];
    EXPECT_LE(before, m.getTime());
    before = m.getTime();
    if (const auto cloud = m.instantiate<sensor_msgs::PointCloud2>()) {
      EXPECT_EQ(cloud->header.stamp, m.getTime());
      EXPECT_EQ(cloud->header.frame_id, "lidar_left");
      EXPECT_EQ(cloud->width, 60U * 32U);
    }
  }
  EXPECT_EQ(found, counts.messages);
}

TEST_F(RecordBag, StaticTransformsAreLatched) {
  convert();
  rosbag::Bag file(bag(), rosbag::bagmode::Read);
  rosbag::View view(file, rosbag::TopicQuery("/tf_static"));
  ASSERT_EQ(view.size(), 1U);
  EXPECT_EQ((*view.begin()).getConnectionHeader()->at("latching"), "1");
}

TEST_F(RecordBag, VideoPacketsAreCopiedByteByByte) {
  atlas::RecordOptions options;
  options.topics = {"camera_ir/packets"};
  convert(options);
  std::vector<std::vector<std::uint8_t>> in_record;
  const auto again = atlas::openRecord(record_.path(), options);
  while (const auto event = again->next()) {
    if (event->stream != 0) in_record.push_back(std::get<atlas::VideoPacketPtr>(event->payload)->data);
  }
  rosbag::Bag file(bag(), rosbag::bagmode::Read);
  rosbag::View view(file, rosbag::TopicQuery("/camera_ir/packets"));
  ASSERT_EQ(view.size(), in_record.size());
  std::size_t i = 0;
  for (const rosbag::MessageInstance& m : view) {
    const auto packet = m.instantiate<atlas_msgs::VideoPacket>();
    ASSERT_NE(packet, nullptr);
    EXPECT_EQ(packet->codec, "hevc");
    EXPECT_EQ(packet->data, in_record[i++]);
  }
}

TEST_F(RecordBag, SummaryAccountsForEveryFile) {
  record_.write("imu/mag.txt", "garbage\n" + record_.read("imu/mag.txt"));
  const BagCounts counts = convert();
  const std::vector<std::string> lines = conversionSummary(*reader_, counts);
  const auto says = [&](const std::string& words) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& l) { return l.find(words) != std::string::npos; });
  };
  for (const auto& [name, file] : reader_->report()) EXPECT_TRUE(says("  " + name)) << name;
  EXPECT_TRUE(says("       101        100          1  imu/mag.txt"));
  EXPECT_TRUE(says("e.g. imu/mag.txt:1: expected 4 fields, found 1"));
  EXPECT_TRUE(says("note: imu: acceleration sign inverted, corrected"));
}

TEST_F(RecordBag, InterruptedBagIsClosedAndDoesNotTakeTheName) {
  const auto reader = atlas::openRecord(record_.path(), {});
  int left = 100;
  const BagCounts counts = writeBag(*reader, bag(), [&left](atlas::Stamp) { return left-- > 0; });
  EXPECT_FALSE(counts.complete);
  EXPECT_FALSE(std::filesystem::exists(bag()));
  rosbag::Bag file(bag() + ".part", rosbag::bagmode::Read);
  EXPECT_EQ(rosbag::View(file).size(), 100U);
}

TEST_F(RecordBag, WhatCannotBeWrittenIsNamedAndLeavesNothing) {
  const auto reader = atlas::openRecord(record_.path(), {});
  try {
    writeBag(*reader, (out_ / "no/such/folder.bag").string(), [](atlas::Stamp) { return true; });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no/such/folder.bag"), std::string::npos);
  }
  atlas::RecordOptions options;
  options.topics = {"no/such/topic"};
  EXPECT_THROW(convert(options), std::runtime_error) << "an empty bag helps nobody";
  EXPECT_TRUE(std::filesystem::is_empty(out_.path()));
}

TEST_F(RecordBag, CheckerFindsWhatIsWrongWithIt) {
  record_.write("calibrations/frames.yaml",
                "imu:\n  trans: [0, 0, 0]\n  rot: [0, 0, 0, 1]\ngnss_rear:\n  trans: [-0.48, -0.19, 0]\n  "
                "rot: [0, 0, 0, 1]\n");
  std::filesystem::remove(record_ / ("lidar_left/" + atlas::test::scanName(3)));
  convert();
  const BagCheck check = checkBag(bag());
  std::string all;
  for (const std::string& problem : check.problems) all += problem + "\n";
  EXPECT_NE(all.find("/lidar_left/points: 1 of 10 clouds are empty"), std::string::npos) << all;
  EXPECT_NE(all.find("/lidar_left/points: frame 'lidar_left' has no place in /tf_static"), std::string::npos)
      << all;
  EXPECT_NE(all.find("/radar_ti/scan: frame 'radar_ti' has no place"), std::string::npos) << all;
  EXPECT_EQ(all.find("gravity"), std::string::npos)
      << "the reader has turned the acceleration round: " << all;
  EXPECT_EQ(check.topics.at("/imu/data").messages, 400U);
  EXPECT_NEAR(check.topics.at("/imu/data").rate_hz, 400.0, 1e-6);
}

TEST(CheckBag, CutBagIsNamed) {
  const TemporaryFolder out;
  {
    rosbag::Bag bag((out / "a.bag").string(), rosbag::bagmode::Write);
    for (std::uint32_t i = 1; i < 2000; ++i) {
      sensor_msgs::Imu imu;
      imu.header.stamp = ros::Time(i, 0);
      bag.write("/imu/data", imu.header.stamp, imu);
    }
    bag.close();
  }
  const std::string whole = out.read("a.bag");
  for (const std::size_t size : {whole.size() / 2, whole.size() - 10, std::size_t{20}, std::size_t{0}}) {
    out.write("cut.bag", whole.substr(0, size));
    try {
      checkBag((out / "cut.bag").string());
      ADD_FAILURE() << size;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("cut.bag"), std::string::npos) << size;
    }
  }
}

}  // namespace
}  // namespace atlas_loader
