// SPDX-License-Identifier: MIT
// Own vehicle, dead beams, duplicate returns.
#include "atlas/lidar/point_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

LidarPoint at(float x, float y, float z, std::uint16_t ring = 0) { return {x, y, z, 7, 0.01F, ring, 0}; }

SweepPtr sweepOf(std::vector<LidarPoint> points) {
  auto sweep = std::make_shared<Sweep>();
  sweep->points = std::move(points);
  return sweep;
}

TEST(PointFilter, VehicleBoxIsInTheVehiclesFrame) {
  PointFilter filter;
  filter.vehicle = vehicleBoxFrom({-2, -1, 0, 2, 1, 1.5});
  // The lidar sits on the roof 1 m ahead and looks to the left.
  const Pose T_imu_lidar{fromRollPitchYaw({0, 0, M_PI / 2}), Eigen::Vector3d(1, 0, 1.6)};
  const auto result =
      filterPoints(sweepOf({at(0, 2, -1), at(0, 4, -1), at(1.5F, 2, -1), at(0, 2, 0), at(0.9F, 2.9F, -1.5F)}),
                   filter, T_imu_lidar);
  EXPECT_EQ(result.on_vehicle, 2U);
  const std::vector<bool> kept = {false, true, true, true, false};
  ASSERT_EQ(result.sweep->points.size(), kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(std::isfinite(result.sweep->points[i].x), kept[i]) << i;
    EXPECT_EQ(result.sweep->points[i].time, 0.01F) << "a place keeps its time";
  }
}

TEST(PointFilter, DeadRingsAreLeftOut) {
  PointFilter filter;
  filter.dead_rings = {3, 65535};
  const auto result =
      filterPoints(sweepOf({at(1, 2, 3, 3), at(1, 2, 3, 4), at(1, 2, 3, 65535)}), filter, Pose{});
  EXPECT_EQ(result.of_dead_rings, 2U);
  EXPECT_TRUE(std::isnan(result.sweep->points[0].z));
  EXPECT_EQ(result.sweep->points[1].x, 1.0F);
}

TEST(PointFilter, DuplicatesAreOfTheSameRing) {
  PointFilter filter;
  filter.drop_duplicates = true;
  const LidarPoint none = at(NAN, NAN, NAN, 1);
  const auto result =
      filterPoints(sweepOf({at(1, 2, 3, 1), at(1, 2, 3, 2), at(1, 2, 3, 1), at(1, 2, 3.001F, 1), none, none}),
                   filter, Pose{});
  EXPECT_EQ(result.duplicates, 1U);
  EXPECT_TRUE(std::isnan(result.sweep->points[2].x));
  EXPECT_TRUE(std::isfinite(result.sweep->points[1].x));
  EXPECT_TRUE(std::isfinite(result.sweep->points[3].x));
}

TEST(PointFilter, WithoutAnythingToDoTheSweepIsShared) {
  const SweepPtr sweep = sweepOf({at(1, 2, 3)});
  EXPECT_EQ(filterPoints(sweep, {}, Pose{}).sweep, sweep);
  PointFilter filter;
  filter.dead_rings = {9};
  EXPECT_EQ(filterPoints(sweep, filter, Pose{}).sweep, sweep);
}

TEST(PointFilter, LimitsAreCheckedByName) {
  EXPECT_FALSE(vehicleBoxFrom({}));
  EXPECT_THROW((void)vehicleBoxFrom({1, 2, 3}), std::invalid_argument);
  EXPECT_THROW((void)vehicleBoxFrom({0, 0, 0, 1, 1, 0}), std::invalid_argument);
  DeskewParams params;
  params.dead_rings = {-1};
  EXPECT_THROW(validate(params), std::invalid_argument);
}

TEST(PointFilter, StageFiltersAndCounts) {
  const test::Drive drive;
  DeskewParams params = test::oneLidar();
  params.dead_rings = {5};
  test::DeskewRun run(params);
  run.rig(drive);
  for (const Odometry& o : drive.odometry(0.9, 1.2)) run.stage.push(o);
  run.stage.push(0, test::seeWall(drive, 1.0, 640).sweep);
  run.finish();
  ASSERT_EQ(run.answers.size(), 1U);
  EXPECT_EQ(run.stage.counters().get("points of dead rings"), 20U);
  for (const LidarPoint& p : run.answers[0].batched->sweep->points)
    EXPECT_EQ(std::isfinite(p.x), p.ring != 5);
}

}  // namespace
}  // namespace atlas
