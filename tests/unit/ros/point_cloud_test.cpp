// SPDX-License-Identifier: MIT
// PointCloud2 layouts of other drivers, and clouds that cannot be used.
#include "atlas_ros/point_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace {

using sensor_msgs::PointField;

void addField(sensor_msgs::PointCloud2& msg, const std::string& name, std::uint8_t type,
              std::uint32_t offset) {
  PointField field;
  field.name = name;
  field.datatype = type;
  field.offset = offset;
  field.count = 1;
  msg.fields.push_back(field);
}

/// Two points with double coordinates, a uint32 `t` in ns and a uint8 ring, as Ouster-like drivers publish.
sensor_msgs::PointCloud2 foreignCloud() {
  sensor_msgs::PointCloud2 msg;
  msg.header.stamp = ros::Time(100, 500);
  msg.width = 2;
  msg.height = 1;
  msg.point_step = 32;
  msg.row_step = 64;
  addField(msg, "x", PointField::FLOAT64, 0);
  addField(msg, "y", PointField::FLOAT64, 8);
  addField(msg, "z", PointField::FLOAT64, 16);
  addField(msg, "t", PointField::UINT32, 24);
  addField(msg, "ring", PointField::UINT8, 28);
  msg.data.assign(64, 0);
  const double xyz[2][3] = {{1.5, 2.0, -3.0}, {0, 0, 0}};
  const std::uint32_t t[2] = {0, 50'000'000};
  for (int i = 0; i < 2; ++i) {
    std::memcpy(&msg.data[static_cast<std::size_t>(32 * i)], xyz[i], 24);
    std::memcpy(&msg.data[static_cast<std::size_t>(32 * i + 24)], &t[i], 4);
    msg.data[static_cast<std::size_t>(32 * i + 28)] = static_cast<std::uint8_t>(40 + i);
  }
  return msg;
}

TEST(PointCloud, ReadsForeignFieldsByName) {
  const auto sweep = atlas_ros::fromMsg(foreignCloud());
  ASSERT_TRUE(sweep);
  ASSERT_EQ((*sweep)->points.size(), 2U);
  EXPECT_FLOAT_EQ((*sweep)->points[0].x, 1.5F);
  EXPECT_FLOAT_EQ((*sweep)->points[0].z, -3.0F);
  EXPECT_EQ((*sweep)->points[0].ring, 40);
  EXPECT_FLOAT_EQ((*sweep)->points[1].time, 0.05F);
}

TEST(PointCloud, OriginMeansNoReturn) {
  const auto sweep = atlas_ros::fromMsg(foreignCloud());
  EXPECT_TRUE(std::isnan((*sweep)->points[1].x));
}

/// The same cloud as a big-endian machine writes it.
sensor_msgs::PointCloud2 bigEndian(sensor_msgs::PointCloud2 msg, const std::vector<std::size_t>& sizes) {
  msg.is_bigendian = 1;
  for (std::size_t point = 0; point < msg.data.size(); point += msg.point_step) {
    for (std::size_t f = 0; f < msg.fields.size(); ++f) {
      const auto begin = msg.data.begin() + static_cast<std::ptrdiff_t>(point + msg.fields[f].offset);
      std::reverse(begin, begin + static_cast<std::ptrdiff_t>(sizes[f]));
    }
  }
  return msg;
}

TEST(PointCloud, BigEndianIsReadAsTheSameCloud) {
  const auto same = [](const sensor_msgs::PointCloud2& msg, const std::vector<std::size_t>& sizes) {
    const auto little = atlas_ros::fromMsg(msg), big = atlas_ros::fromMsg(bigEndian(msg, sizes));
    ASSERT_TRUE(little && big);
    ASSERT_EQ((*big)->points.size(), (*little)->points.size());
    EXPECT_EQ((*big)->points[0].x, (*little)->points[0].x);
    EXPECT_EQ((*big)->points[0].z, (*little)->points[0].z);
    EXPECT_EQ((*big)->points[0].ring, (*little)->points[0].ring);
    EXPECT_EQ((*big)->points[1].time, (*little)->points[1].time);
  };
  same(foreignCloud(), {8, 8, 8, 4, 1});
  atlas::Sweep own;  // in our own layout, which is copied as a whole when it can be
  own.points = {{1.5F, 2.0F, -3.0F, 7.0F, 0.01F, 300, 0}, {4.0F, 5.0F, 6.0F, 8.0F, 0.02F, 301, 0}};
  same(atlas_ros::toMsg(own), {4, 4, 4, 4, 4, 2});
}

TEST(PointCloud, RefusesShortDataAndMissingFields) {
  auto cut = foreignCloud();
  cut.data.resize(40);
  EXPECT_EQ(atlas_ros::fromMsg(cut).reason(), atlas::Reason::kBadLayout);
  auto no_z = foreignCloud();
  no_z.fields[2].name = "w";
  EXPECT_EQ(atlas_ros::fromMsg(no_z).reason(), atlas::Reason::kBadLayout);
  auto outside = foreignCloud();
  outside.fields[2].offset = 28;  // 8 bytes from there pass the end of the point
  EXPECT_EQ(atlas_ros::fromMsg(outside).reason(), atlas::Reason::kBadLayout);
}

TEST(PointCloud, EmptyIsAnEmptySweep) {
  sensor_msgs::PointCloud2 msg;
  msg.header.frame_id = "lidar_left";
  const auto sweep = atlas_ros::fromMsg(msg);
  ASSERT_TRUE(sweep);
  EXPECT_TRUE((*sweep)->points.empty());
  EXPECT_EQ((*sweep)->frame, "lidar_left");
}

TEST(PointCloud, OwnLayoutRoundTrips) {
  atlas::Sweep sweep;
  sweep.stamp = 1568186745408734467;
  sweep.frame = "lidar_right";
  sweep.points.push_back({1, 2, 3, 4, -0.1F, 17, 0});
  const auto back = atlas_ros::fromMsg(atlas_ros::toMsg(sweep));
  ASSERT_TRUE(back);
  EXPECT_EQ((*back)->stamp, sweep.stamp);
  EXPECT_EQ(std::memcmp((*back)->points.data(), sweep.points.data(), sizeof(atlas::LidarPoint)), 0);
}

}  // namespace
