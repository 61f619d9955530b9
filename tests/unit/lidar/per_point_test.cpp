// SPDX-License-Identifier: MIT
// De-skew by the pose at each point's own time.
#include "atlas/lidar/per_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

using namespace test;

constexpr double kFloat_m = 5e-5;  // of coordinates in the lidar frame and in map, twice rounded

TEST(PerPoint, EveryPointIsWhereItWasSeen) {
  for (const double yaw_rate_radps : {0.0, 0.5, -1.0}) {
    Drive drive;
    drive.yaw_rate_radps = yaw_rate_radps;
    const SeenSweep seen = seeWall(drive, 1.0, 3200);
    const auto batched = deskewOne(drive, seen.sweep, oneLidar(0));
    ASSERT_TRUE(batched);
    ASSERT_EQ(batched->batches.size(), 1U);
    EXPECT_LT(worstError(inMap(*batched), seen.truth_map), kFloat_m) << yaw_rate_radps;
  }
}

TEST(PerPoint, OneHundredBatchesLeaveAStepThatItDoesNot) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 3200);
  const double batches_m = worstError(inMap(*deskewOne(drive, seen.sweep, oneLidar(100))), seen.truth_map);
  const double per_point_m = worstError(inMap(*deskewOne(drive, seen.sweep, oneLidar(0))), seen.truth_map);
  EXPECT_GT(batches_m, 0.002) << "half a batch is 0.5 ms at 10 m/s and 0.5 rad/s";
  EXPECT_LT(per_point_m, batches_m / 20);
}

TEST(PerPoint, OrderOfThePointsDoesNotMatter) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 640);
  auto reversed = std::make_shared<Sweep>(*seen.sweep);
  std::reverse(reversed->points.begin(), reversed->points.end());
  const auto forward = deskewOne(drive, seen.sweep, oneLidar(0));
  const auto backward = deskewOne(drive, reversed, oneLidar(0));
  for (std::size_t i = 0; i < 640; ++i) {
    EXPECT_EQ(forward->sweep->points[i].x, backward->sweep->points[639 - i].x);
    EXPECT_EQ(forward->sweep->points[i].y, backward->sweep->points[639 - i].y);
  }
}

TEST(PerPoint, KeepsTimeRingIntensityAndPlacesWithoutReturn) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 1000);
  seen.sweep->points[17].x = seen.sweep->points[17].y = seen.sweep->points[17].z =
      std::numeric_limits<float>::quiet_NaN();
  const auto batched = deskewOne(drive, seen.sweep, oneLidar(0));
  ASSERT_EQ(batched->sweep->points.size(), 1000U);
  for (std::size_t i = 0; i < 1000; ++i) {
    const LidarPoint& in = seen.sweep->points[i];
    const LidarPoint& out = batched->sweep->points[i];
    EXPECT_EQ(std::isfinite(out.x) && std::isfinite(out.y) && std::isfinite(out.z), i != 17);
    EXPECT_EQ(out.time, in.time);
    EXPECT_EQ(out.ring, in.ring);
    EXPECT_EQ(out.intensity, in.intensity);
  }
}

TEST(PerPoint, WithoutAPoseThereIsNoAnswer) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 100);
  const auto span = spanOf(*seen.sweep);
  const auto answer = [&](double from_s, double to_s) {
    return deskewPerPoint(seen.sweep, *span, drive.trajectory(from_s, to_s), drive.T_imu_lidar);
  };
  EXPECT_TRUE(answer(0.9, 1.2));
  EXPECT_EQ(answer(1.05, 1.2).reason(), Reason::kNoPoseYet);
  EXPECT_EQ(answer(0.9, 1.05).reason(), Reason::kPoseNotReached);
}

}  // namespace
}  // namespace atlas
