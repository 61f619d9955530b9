// SPDX-License-Identifier: MIT
#include "atlas/fusion/local_map.hpp"

#include <gtest/gtest.h>

#include "tracking_scene.hpp"

namespace atlas {
namespace {

Odometry pose(double t_s) {
  Odometry odometry;
  odometry.stamp = at(t_s);
  odometry.T_map_imu.translation = {10.0 * t_s, 0.0, 0.0};
  return odometry;
}
ObjectsPtr objectsAt(double t_s) {
  auto objects = std::make_shared<Objects>();
  objects->stamp = at(t_s);
  for (const double x : {0.0, 50.0, 100.0}) {
    objects->objects.emplace_back();
    objects->objects.back().id = static_cast<std::uint32_t>(x) + 1;
    objects->objects.back().position.x() = x;
  }
  return objects;
}
MapCloudPtr cloudAt(double t_s) {
  auto cloud = std::make_shared<MapCloud>();
  cloud->stamp = at(t_s);
  for (float x = 0.0F; x <= 100.0F; x += 10.0F) cloud->points.push_back({x, 0.0F, 0.0F, 0.0F, 0.0F, 0, 0});
  return cloud;
}

TEST(LocalMap, WhatWasAroundTheVehicleAtATime) {
  LocalMapParams params;
  params.radius_m = 30.0;
  LocalMap map(params);
  EXPECT_EQ(map.newest(30.0).reason(), Reason::kNoPoseYet);
  for (double t = 0.0; t <= 5.0; t += 0.1) EXPECT_FALSE(map.add(pose(t)).has_value());
  map.add(objectsAt(1.0));
  map.add(cloudAt(2.0));
  Frustums frustums;
  frustums.stamp = at(4.9);
  frustums.frustums.resize(2);
  frustums.frustums[1].position = {60.0, 0.0, 0.0};
  map.add(frustums);
  auto grid = std::make_shared<OccupancyMap>();
  grid->stamp = at(3.0);
  map.add(OccupancyMapPtr(grid));
  const auto view = map.at(at(4.95));
  ASSERT_TRUE(view);
  EXPECT_NEAR(view->T_map_imu.translation.x(), 49.5, 1e-6);
  ASSERT_EQ(view->objects.objects.size(), 1U);
  EXPECT_EQ(view->objects.objects[0].id, 51U);
  EXPECT_EQ(view->cloud->points.size(), 6U) << "20, 30, ..., 70 m";
  ASSERT_EQ(view->frustums.size(), 1U);
  EXPECT_EQ(view->frustums[0].frustums.size(), 1U);
  EXPECT_EQ(view->grid, grid);
  EXPECT_EQ(map.at(at(2.9))->grid, nullptr);
  EXPECT_TRUE(map.at(at(0.5))->objects.objects.empty()) << "before the first objects";
  EXPECT_EQ(map.at(at(0.5))->cloud, nullptr);
  EXPECT_EQ(map.at(at(6.0)).reason(), Reason::kPoseNotReached);
  EXPECT_EQ(map.at(at(-1.0)).reason(), Reason::kNoPoseYet);
}

TEST(LocalMap, IsBoundedAndRefusesWhatGoesBack) {
  LocalMapParams params;
  params.history_s = 1.0;
  LocalMap map(params);
  for (double t = 0.0; t <= 10.0; t += 0.1) {
    map.add(pose(t));
    map.add(objectsAt(t));
  }
  EXPECT_EQ(map.at(at(5.0)).reason(), Reason::kNoPoseYet);
  EXPECT_TRUE(map.at(at(9.5)));
  EXPECT_EQ(map.add(pose(3.0)), Reason::kOutOfOrder);
  EXPECT_EQ(map.add(objectsAt(3.0)), Reason::kOutOfOrder);
  params.radius_m = 0.0;
  EXPECT_THROW(LocalMap{params}, std::invalid_argument);
}

TEST(LocalMapStage, GivesAMapAtTheChosenRate) {
  LocalMapParams params;
  params.period_s = 0.5;
  LocalMapStage stage(params);
  std::vector<Stamp> stamps;
  stage.on_map = [&](const LocalMapView& view) { stamps.push_back(view.stamp); };
  for (std::size_t input : {1U, 2U, 3U, 4U}) stage.finish(input);
  for (int i = 0; i <= 100; ++i) stage.push(pose(0.02 * i));
  stage.finish(0);
  ASSERT_EQ(stamps.size(), 3U);
  EXPECT_EQ(stamps[0], at(0.5));
  EXPECT_EQ(stamps[2], at(1.5));
}

}  // namespace
}  // namespace atlas
