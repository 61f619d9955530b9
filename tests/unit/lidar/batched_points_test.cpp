// SPDX-License-Identifier: MIT
#include "atlas/lidar/batched_points.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

using namespace test;

LidarPoint pointAt(float x, float y, float z, float time = 0.0F) {
  LidarPoint p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.time = time;
  p.intensity = 9.0F;
  p.ring = 5;
  return p;
}

/// Two batches: the lidar at (10, 0, 0) looking north, then at (20, 0, 0) looking west. Stamp: the second
/// pose.
BatchedSweep twoPoses() {
  auto sweep = std::make_shared<Sweep>();
  sweep->points = {pointAt(1, 0, 0, -0.1F), pointAt(0, 2, 3, -0.05F), pointAt(1, 0, 0)};
  BatchedSweep batched;
  batched.stamp = at(1.0);
  batched.frame = "lidar_left";
  batched.sweep = sweep;
  const Pose first{fromRollPitchYaw({0, 0, M_PI / 2}), {10, 0, 0}},
      second{fromRollPitchYaw({0, 0, M_PI}), {20, 0, 0}};
  batched.batches = {{0, 2, at(0.9), first}, {2, 1, at(1.0), second}};
  batched.T_map_lidar = second;
  return batched;
}

TEST(BatchedPoints, byHand) {
  const MapCloud map = inMap(twoPoses());
  EXPECT_EQ(map.stamp, at(1.0));
  ASSERT_EQ(map.points.size(), 3U);
  EXPECT_LT(distance(map.points[0], {10, 1, 0}), 1e-6);
  EXPECT_LT(distance(map.points[1], {8, 0, 3}), 1e-6);
  EXPECT_LT(distance(map.points[2], {19, 0, 0}), 1e-6);
  // Seen from (20, 0, 0) looking west: x = 20 - x_map, y = -y_map.
  const Sweep still = deskewed(twoPoses());
  EXPECT_EQ(still.frame, "lidar_left");
  EXPECT_LT(distance(still.points[0], {10, -1, 0}), 1e-5);
  EXPECT_LT(distance(still.points[1], {12, 0, 3}), 1e-5);
  EXPECT_LT(distance(still.points[2], {1, 0, 0}), 1e-5) << "measured at the stamp: where it was";
  EXPECT_EQ(still.points[0].time, -0.1F);
  EXPECT_EQ(still.points[0].intensity, 9.0F);
  EXPECT_EQ(still.points[0].ring, 5);
}

TEST(BatchedPoints, BatchOfEachPointWhenTheyAreNotInOrderOfTime) {
  BatchedSweep batched = twoPoses();
  batched.batch_of_point = {1, 0, 1};
  const MapCloud map = inMap(batched);
  EXPECT_LT(distance(map.points[0], {19, 0, 0}), 1e-6);
  EXPECT_LT(distance(map.points[1], {8, 0, 3}), 1e-6);
}

TEST(BatchedPoints, TheDeskewedSweepIsTheMapSeenFromItsStamp) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 700);
  const BatchedSweepPtr batched = deskewOne(drive, seen.sweep, oneLidar(50));
  ASSERT_TRUE(batched);
  const Sweep still = deskewed(*batched);
  const MapCloud map = inMap(*batched);
  for (std::size_t i = 0; i < still.points.size(); ++i) {
    const LidarPoint& p = still.points[i];
    EXPECT_LT(distance(map.points[i], batched->T_map_lidar * Eigen::Vector3d(p.x, p.y, p.z)), 1e-5);
  }
}

TEST(BatchedPoints, FarFromTheOriginAMillimetreIsAMillimetre) {
  BatchedSweep batched = twoPoses();
  for (Batch& batch : batched.batches) batch.T_map_lidar.translation += Eigen::Vector3d(8000, -3000, 200);
  batched.T_map_lidar = batched.batches[1].T_map_lidar;
  // float32 holds 8 km to 0.5 mm; a float product would add its own errors, and deskewed() has none of them
  EXPECT_LT(distance(inMap(batched).points[1], {8008, -3000, 203}), 6e-4);
  EXPECT_LT(distance(deskewed(batched).points[1], {12, 0, 3}), 2e-6);
}

TEST(BatchedPoints, UnknownStaysUnknown) {
  BatchedSweep batched = twoPoses();
  auto sweep = std::make_shared<Sweep>(*batched.sweep);
  sweep->points[1].x = sweep->points[1].y = sweep->points[1].z = std::numeric_limits<float>::quiet_NaN();
  batched.sweep = sweep;
  EXPECT_TRUE(std::isnan(inMap(batched).points[1].x));
  EXPECT_FALSE(std::isnan(inMap(batched).points[2].x));
  batched.batches.clear();  // there was no pose
  for (const LidarPoint& p : inMap(batched).points)
    EXPECT_TRUE(std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z));
  EXPECT_EQ(deskewed(batched).points.size(), 3U) << "the order of the input is kept all the same";
}

}  // namespace
}  // namespace atlas
