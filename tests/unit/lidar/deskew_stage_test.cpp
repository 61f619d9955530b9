// SPDX-License-Identifier: MIT
// What a de-skewed sweep looks like: geometry, and the wrong results of the published program that touch it
// (W1, W4, W5).
#include "atlas/lidar/deskew_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

using namespace test;

constexpr double kFloat_m =
    5e-6;  ///< 20 m in float32, twice (in and out), and 4 ns of a float time at 10 m/s

TEST(Deskew, PerPointPosesLeaveOnlyRounding) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 2000);
  const auto batched = deskewOne(drive, seen.sweep, oneLidar(2000));
  ASSERT_TRUE(batched);
  EXPECT_LT(worstError(inMap(*batched), seen.truth_map), kFloat_m);
}

TEST(Deskew, HundredBatchesAreBoundedByTheirDuration) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 2000);
  const auto batched = deskewOne(drive, seen.sweep, oneLidar(100));
  ASSERT_TRUE(batched);
  // half a batch (0.5 ms) of 10 m/s, and of 0.5 rad/s at most 16 m away
  const double bound_m = 0.0005 * (10.0 + 0.5 * 16.0);
  const double worst_m = worstError(inMap(*batched), seen.truth_map);
  EXPECT_LT(worst_m, bound_m);
  EXPECT_GT(worst_m, 0.2 * bound_m) << "the bound means something";
  // without de-skewing: 0.1 s of motion
  const auto one = deskewOne(drive, seen.sweep, oneLidar(1));
  EXPECT_GT(worstError(inMap(*one), seen.truth_map), 0.5);
}

TEST(Deskew, SweepAtItsStamp) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 500);
  const auto batched = deskewOne(drive, seen.sweep, oneLidar(500));
  const Sweep still = deskewed(*batched);
  const Pose T_map_lidar = drive.arc(1.0) * drive.T_imu_lidar;
  EXPECT_EQ(still.stamp, seen.sweep->stamp);
  EXPECT_EQ(still.frame, "lidar_left");
  for (std::size_t i = 0; i < still.points.size(); ++i) {
    EXPECT_LT(distance(still.points[i], T_map_lidar.inverse() * seen.truth_map[i]), kFloat_m);
    EXPECT_EQ(still.points[i].time, seen.sweep->points[i].time);
  }
}

// W5: the published program took the travel in world axes for one in vehicle axes: right at heading 0 only.
TEST(Deskew, W5_HeadingHasNoInfluence) {
  for (const double heading_deg : {0.0, 45.0, 90.0, 180.0, -90.0}) {
    Drive drive;
    drive.yaw_rate_radps = 0.0;
    drive.heading_rad = heading_deg * M_PI / 180.0;
    const SeenSweep seen = seeWall(drive, 1.0, 1000);
    const auto batched = deskewOne(drive, seen.sweep, oneLidar(1000));
    ASSERT_TRUE(batched);
    EXPECT_LT(worstError(inMap(*batched), seen.truth_map), kFloat_m) << "heading " << heading_deg << " deg";
  }
}

// W4: the published program thinned the cloud before it cut it, after which a batch held points of all times.
TEST(Deskew, W4_BatchesSpanTheirShareOfTheSweep) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 3200);
  const auto batched = deskewOne(drive, seen.sweep, oneLidar(100));
  for (const Batch& batch : batched->batches) {
    const auto& points = batched->sweep->points;
    const double span_s = points[batch.first + batch.count - 1].time - points[batch.first].time;
    EXPECT_LE(span_s, 0.1 / 100 + 1e-6);
  }
}

TEST(Deskew, W4_OutputKeepsOrderAndLengthOfTheInput) {
  const Drive drive;
  SeenSweep seen = seeWall(drive, 1.0, 1000);
  seen.sweep->points[17].x = std::numeric_limits<float>::quiet_NaN();  // no return
  seen.sweep->points[18] =
      LidarPoint{0, 0, 0, 0, seen.sweep->points[18].time, 4, 0};  // no return, other style
  const auto batched = deskewOne(drive, seen.sweep, oneLidar(100));
  const MapCloud cloud = inMap(*batched);
  ASSERT_EQ(cloud.points.size(), 1000U);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const bool known = i != 17 && i != 18;
    EXPECT_EQ(std::isfinite(cloud.points[i].x), known);
    EXPECT_EQ(std::isfinite(cloud.points[i].z), known);
    EXPECT_EQ(cloud.points[i].time, seen.sweep->points[i].time);
    EXPECT_EQ(cloud.points[i].ring, seen.sweep->points[i].ring);
    if (known) {
      EXPECT_LT(distance(cloud.points[i], seen.truth_map[i]), 0.01);
    }
  }
}

// W1: the published program kept the first sweep as "previous sweep" of all others.
TEST(Deskew, W1_EverySweepHasItsOwnPoses) {
  const Drive drive;
  DeskewRun run(oneLidar(500));
  run.rig(drive);
  std::vector<SeenSweep> seen;
  for (const Odometry& o : drive.odometry(0.5, 2.0)) run.stage.push(o);
  for (const double stamp_s : {1.0, 1.1, 1.2}) {
    seen.push_back(seeWall(drive, stamp_s, 500));
    run.stage.push(0, seen.back().sweep);
  }
  run.finish();
  ASSERT_EQ(run.answers.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(worstError(inMap(*run.answers[i].batched), seen[i].truth_map), kFloat_m);
    EXPECT_LT((run.answers[i].batched->T_map_lidar.translation -
               (drive.arc(1.0 + 0.1 * static_cast<double>(i)) * drive.T_imu_lidar).translation)
                  .norm(),
              1e-9);
  }
}

TEST(Deskew, LaserByLaserGivesTheSamePlaces) {
  const Drive drive;
  const SeenSweep seen = seeWall(drive, 1.0, 3200);
  auto by_laser = std::make_shared<Sweep>(*seen.sweep);
  std::vector<std::size_t> order(3200);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return seen.sweep->points[a].ring > seen.sweep->points[b].ring;  // top laser first, as KITTI
  });
  std::vector<Eigen::Vector3d> truth_map;
  for (std::size_t i = 0; i < order.size(); ++i) {
    by_laser->points[i] = seen.sweep->points[order[i]];
    truth_map.push_back(seen.truth_map[order[i]]);
  }
  const auto batched = deskewOne(drive, by_laser, oneLidar(100));
  ASSERT_TRUE(batched);
  EXPECT_LT(worstError(inMap(*batched), truth_map),
            0.0005 * (10.0 + 0.5 * 16.0) * 1.1);  // a bin may be off by a column
  for (std::size_t i = 0; i < order.size(); ++i)
    EXPECT_EQ(batched->sweep->points[i].ring, by_laser->points[i].ring);
}

TEST(Deskew, WithoutPoseNothingIsInMap) {
  BatchedSweep batched;
  auto sweep = std::make_shared<Sweep>();
  sweep->points.resize(3);
  sweep->points[1].x = 5.0F;
  batched.sweep = sweep;
  for (const std::vector<LidarPoint>& points : {inMap(batched).points, deskewed(batched).points}) {
    ASSERT_EQ(points.size(), 3U);
    for (const LidarPoint& p : points) EXPECT_TRUE(std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z));
  }
}

TEST(Deskew, RefusesParametersByName) {
  const auto message = [](DeskewParams params) -> std::string {
    try {
      DeskewStage stage(params);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  DeskewParams params;
  params.batches_per_sweep = -1;
  EXPECT_NE(message(params).find("batches_per_sweep"), std::string::npos);
  params = {};
  params.max_range_m = 0.5;
  EXPECT_NE(message(params).find("max_range_m"), std::string::npos);
  params = {};
  params.motion = "dead reckoning";
  EXPECT_NE(message(params).find("motion must be velocities or poses, got 'dead reckoning'"),
            std::string::npos);
  params = {};
  params.max_pose_gap_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message(params).find("max_pose_gap_s"), std::string::npos);
  params = {};
  params.lidars.clear();
  EXPECT_NE(message(params).find("lidars"), std::string::npos);
}

}  // namespace
}  // namespace atlas
