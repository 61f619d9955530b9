// SPDX-License-Identifier: MIT
// Bags are read in the order of the stamps; every message is accounted for.
#include "atlas_ros/bag_reader.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "atlas_ros/conversions.hpp"

namespace {

namespace fs = std::filesystem;

class BagReader : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = fs::path(::testing::TempDir()) / ("atlas_bag_reader_" + std::to_string(::getpid()) + ".bag");
  }
  void TearDown() override { fs::remove(path_); }
  static sensor_msgs::Imu imu(double stamp_s) {
    sensor_msgs::Imu msg;
    msg.header.stamp = ros::Time(stamp_s);
    return msg;
  }
  fs::path path_;
};

TEST_F(BagReader, OrdersByStampAndAccountsForEveryMessage) {
  {
    rosbag::Bag bag(path_.string(), rosbag::bagmode::Write);
    bag.write("/imu/data", ros::Time(100.0), imu(99.9));
    bag.write("/other/imu", ros::Time(100.1), imu(99.7));  // recorded later, measured earlier
    sensor_msgs::Imu bad = imu(100.0);
    bad.angular_velocity.x = std::nan("");
    bag.write("/imu/data", ros::Time(100.2), bad);
    bag.write("/imu/data", ros::Time(110.0), imu(110.0));
    bag.write("/imu/data", ros::Time(110.1), imu(101.0));  // more than the reorder window too late
  }
  const auto reader = atlas_ros::openBag(path_.string(), {});
  std::vector<double> stamps;
  while (const auto event = reader->next()) stamps.push_back(atlas::toSeconds(event->stamp));
  EXPECT_EQ(stamps, (std::vector<double>{99.7, 99.9, 101.0, 110.0}));
  const auto report = reader->report();
  const auto& file = report.at("imu/data");
  EXPECT_EQ(file.rows, 4U);
  EXPECT_EQ(file.used, 3U);
  EXPECT_EQ(file.skipped.at("not finite"), 1U);
}

TEST_F(BagReader, NotABagIsNamed) {
  { std::ofstream(path_) << "no bag"; }
  try {
    atlas_ros::openBag(path_.string(), {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path_.string()), std::string::npos);
  }
}

}  // namespace
