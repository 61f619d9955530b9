// SPDX-License-Identifier: MIT
// Messages of the occupancy filter: both ways unchanged, and what cannot be is refused.
#include "atlas_ros/grid_conversions.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

constexpr atlas::Stamp kStamp = 1568186745408734467;

atlas::OccupancyMap smallMap() {
  atlas::OccupancyMap map;
  map.stamp = kStamp;
  map.resolution_m = 0.2F;
  map.origin = {-4.2, 1.0 / 3.0, 0.1};
  map.columns = 3;
  map.rows = 2;
  map.percent = {-1, 0, 100, 50, 1, 99};
  return map;
}

TEST(OccupancyMap, RoundTripIsExact) {
  const auto msg = atlas_ros::toMsg(smallMap());
  EXPECT_EQ(msg.header.frame_id, "map");
  EXPECT_EQ(msg.info.origin.orientation.w, 1.0);
  const auto back = atlas_ros::fromMsg(msg);
  ASSERT_TRUE(back);
  EXPECT_EQ((*back)->stamp, kStamp);
  EXPECT_EQ((*back)->resolution_m, 0.2F);
  EXPECT_EQ((*back)->origin, smallMap().origin);
  EXPECT_EQ((*back)->columns, 3U);
  EXPECT_EQ((*back)->rows, 2U);
  EXPECT_EQ((*back)->percent, smallMap().percent);
}

TEST(OccupancyMap, WhatCannotBeIsRefused) {
  auto msg = atlas_ros::toMsg(smallMap());
  msg.data.pop_back();
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kBadLayout);
  msg = atlas_ros::toMsg(smallMap());
  msg.data[0] = 101;
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kBadLayout);
  msg = atlas_ros::toMsg(smallMap());
  msg.info.origin.position.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kNotFinite);
}

TEST(CollisionRisk, RoundTripIsExactAndWhatIsUnknownStaysUnknown) {
  atlas::CollisionRisk risk;
  risk.stamp = kStamp;
  risk.bin_s = 0.1;
  risk.first_contact = {0.0, 1.0 / 3.0, 0.125};
  risk.total = 1.0 / 3.0 + 0.125;
  risk.unknown_share = 0.25;
  const auto without = atlas_ros::fromMsg(atlas_ros::toMsg(atlas::RiskAnswer{kStamp, risk}));
  ASSERT_TRUE(without);
  ASSERT_TRUE(without->risk);
  EXPECT_EQ(without->risk->first_contact, risk.first_contact);
  EXPECT_EQ(without->risk->total, risk.total);
  EXPECT_EQ(without->risk->bin_s, risk.bin_s);
  EXPECT_EQ(without->risk->unknown_share, risk.unknown_share);
  EXPECT_FALSE(without->risk->expected_time_s);
  EXPECT_FALSE(without->risk->object);
  risk.expected_time_s = 0.0;  // known, and now: not the same as unknown
  risk.object = 0U;
  const auto with = atlas_ros::fromMsg(atlas_ros::toMsg(atlas::RiskAnswer{kStamp, risk}));
  EXPECT_EQ(with->risk->expected_time_s, 0.0);
  EXPECT_EQ(with->risk->object, 0U);
  const auto unknown = atlas_ros::fromMsg(atlas_ros::toMsg(atlas::RiskAnswer{kStamp, std::nullopt}));
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->stamp, kStamp);
  EXPECT_FALSE(unknown->risk);
}

TEST(CollisionRisk, NoProbabilityIsRefused) {
  atlas_msgs::CollisionRisk msg;
  msg.known = true;
  msg.bin = 0.1;
  msg.total = 1.5;
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kNotFinite);
}

TEST(SensorGrid, RoundTripIsExactAndBadOnesAreRefused) {
  atlas::SensorGrid grid;
  grid.stamp = kStamp;
  grid.frame = "camera_left_front";
  grid.T_sensor_grid = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), Eigen::Vector3d(0.1, 1.3, 0.0)};
  grid.origin_x_m = 1.0;
  grid.origin_y_m = -10.0;
  grid.cell_m = 0.2;
  grid.columns = 2;
  grid.rows = 2;
  grid.occupied = {0.5F, 0.02F, 0.98F, 0.5F};
  const auto back = atlas_ros::fromMsg(atlas_ros::toMsg(grid));
  ASSERT_TRUE(back);
  EXPECT_EQ((*back)->stamp, kStamp);
  EXPECT_EQ((*back)->frame, grid.frame);
  EXPECT_EQ((*back)->T_sensor_grid.translation, grid.T_sensor_grid.translation);
  EXPECT_EQ((*back)->T_sensor_grid.rotation.coeffs(), grid.T_sensor_grid.rotation.coeffs());
  EXPECT_EQ((*back)->origin_x_m, 1.0);
  EXPECT_EQ((*back)->origin_y_m, -10.0);
  EXPECT_EQ((*back)->cell_m, 0.2);
  EXPECT_EQ((*back)->columns, 2);
  EXPECT_EQ((*back)->rows, 2);
  EXPECT_EQ((*back)->occupied, grid.occupied);
  auto msg = atlas_ros::toMsg(grid);
  msg.occupied[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kNotFinite);
  msg = atlas_ros::toMsg(grid);
  msg.rows = 3;
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kBadLayout);
  msg = atlas_ros::toMsg(grid);
  msg.cell = 0.0;
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kBadLayout);
}

}  // namespace
