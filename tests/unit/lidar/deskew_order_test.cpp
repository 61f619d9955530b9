// SPDX-License-Identifier: MIT
// When a sweep is answered: after its odometry (W6), in stamp order, once, whatever the arrival order.
#include <gtest/gtest.h>

#include <random>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

using namespace test;

/// A push or a watermark for one input, to be replayed in any order that keeps each input's own.
struct Step {
  std::size_t input;
  std::function<void(DeskewStage&)> run;
};

DeskewParams twoLidars() {
  DeskewParams params;
  params.batches_per_sweep = 10;
  return params;
}

// W6: the published program used the newest GNSS pose, up to 50 ms old, for the end of the sweep.
TEST(DeskewOrder, W6_WaitsUntilOdometryCoversTheLastPoint) {
  const Drive drive;
  DeskewRun run(oneLidar());
  run.rig(drive);
  const SeenSweep seen = seeWall(drive, 1.0, 200);  // last point at 1.0995 s
  run.stage.push(0, seen.sweep);
  run.stage.finish(DeskewStage::kFirstLidar);
  for (const Odometry& o : drive.odometry(0.9, 1.09)) run.stage.push(o);
  EXPECT_TRUE(run.answers.empty()) << "no stale pose";
  EXPECT_LT(run.stage.progress(), seen.sweep->stamp) << "the answer is still owed";
  run.stage.push(drive.odometry(1.095, 1.1).front());
  ASSERT_EQ(run.answers.size(), 1U) << "no longer than needed";
  EXPECT_EQ(run.stage.progress(), at(1.1) - 1) << "nothing is owed, but another pose of that stamp may come";
  EXPECT_LT(worstError(inMap(*run.answers[0].batched), seen.truth_map), 0.01);
}

TEST(DeskewOrder, EverySweepIsAnsweredOnceInStampOrderWhateverArrivesFirst) {
  const Drive drive;
  std::vector<std::vector<Step>> inputs(4);
  inputs[0].push_back({0, [&](DeskewStage& s) { s.push(0, rigOf(drive, {"lidar_left", "lidar_right"})); }});
  for (const Odometry& o : drive.odometry(0.45, 2.0)) {
    if (o.stamp > at(1.2) && o.stamp < at(1.75)) continue;  // an outage longer than max_pose_gap_s
    inputs[1].push_back({1, [o](DeskewStage& s) { s.push(o); }});
    inputs[1].push_back({1, [o](DeskewStage& s) { s.advance(1, o.stamp); }});
  }
  for (int i = 0; i < 20; ++i) {
    for (std::size_t lidar = 0; lidar < 2; ++lidar) {
      const double stamp_s = 0.3 + 0.1 * i + 0.03 * static_cast<double>(lidar);
      const SweepPtr sweep = seeWall(drive, stamp_s, 50, lidar == 0 ? "lidar_left" : "lidar_right").sweep;
      inputs[2 + lidar].push_back({2 + lidar, [lidar, sweep](DeskewStage& s) { s.push(lidar, sweep); }});
      inputs[2 + lidar].push_back(
          {2 + lidar, [lidar, sweep](DeskewStage& s) { s.advance(2 + lidar, sweep->stamp + 1000); }});
    }
  }
  std::string expected;
  for (unsigned seed = 0; seed < 30; ++seed) {
    DeskewRun run(twoLidars());
    std::mt19937 random(seed);
    std::vector<std::size_t> next(4, 0), open = {0, 1, 2, 3};
    while (!open.empty()) {
      const std::size_t pick = random() % open.size();
      const std::size_t input = open[pick];
      if (next[input] == inputs[input].size()) {
        run.stage.finish(input);
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(pick));
        continue;
      }
      const Step& step = inputs[input][next[input]++];
      const bool only_watermark = seed % 3 == 1 && input > 0 && next[input] % 2 == 0;
      if (!only_watermark) step.run(run.stage);  // every third run goes without watermarks
    }
    ASSERT_TRUE(run.stage.ended());
    ASSERT_EQ(run.answers.size(), 40U);
    std::string all;
    Stamp last = kBeginOfTime;
    for (const DeskewRun::Answer& answer : run.answers) {
      EXPECT_GE(answer.batched->stamp, last);
      last = answer.batched->stamp;
      const MapCloud cloud = inMap(*answer.batched);
      all += std::to_string(answer.lidar) + ":" + std::to_string(answer.batched->batches.size());
      all.append(reinterpret_cast<const char*>(cloud.points.data()),
                 cloud.points.size() * sizeof(LidarPoint));
    }
    for (const auto& [key, count] : run.stage.counters().all())
      all += key + "=" + std::to_string(count) + "\n";
    if (seed == 0) {
      expected = all;
      EXPECT_NE(all.find("skipped sweep of lidar_left: no pose yet"), std::string::npos);
      EXPECT_NE(all.find("skipped sweep of lidar_left: "), std::string::npos);
    }
    EXPECT_EQ(all, expected) << "seed " << seed;
  }
}

TEST(DeskewOrder, OdometryThatStopsDoesNotHoldTheRunBack) {
  const Drive drive;
  DeskewRun run(oneLidar());
  run.rig(drive);
  for (const Odometry& o : drive.odometry(0.9, 1.05)) run.stage.push(o);
  const SweepPtr sweep = seeWall(drive, 1.0, 100).sweep;
  run.stage.push(0, sweep);
  run.stage.advance(DeskewStage::kFirstLidar, at(3.0));
  run.stage.advance(DeskewStage::kOdometry, at(1.4));
  EXPECT_TRUE(run.answers.empty()) << "a pose at 1.45 s could still be joined to the one at 1.05 s";
  run.stage.advance(DeskewStage::kOdometry, at(1.6));
  ASSERT_EQ(run.answers.size(), 1U);
  EXPECT_TRUE(run.answers[0].batched->batches.empty());
  EXPECT_EQ(run.stage.counters().get("skipped sweep of lidar_left: after the newest pose"), 1U);
  EXPECT_EQ(run.stage.progress(), at(1.6));
}

TEST(DeskewOrder, AtTheEndWhatCannotBeAnsweredIsAnsweredEmpty) {
  const Drive drive;
  DeskewRun run(oneLidar());
  run.rig(drive);
  for (const Odometry& o : drive.odometry(0.9, 1.05)) run.stage.push(o);
  for (const double stamp_s : {1.0, 1.1, 1.2}) run.stage.push(0, seeWall(drive, stamp_s, 100).sweep);
  run.finish();
  ASSERT_EQ(run.answers.size(), 3U);
  for (const auto& answer : run.answers) EXPECT_TRUE(answer.batched->batches.empty());
  EXPECT_EQ(run.stage.counters().get("skipped sweep of lidar_left: after the newest pose"), 3U);
  EXPECT_EQ(run.stage.progress(), kEndOfTime);
}

TEST(DeskewOrder, EmptySweepAndUnknownFrameAreAnsweredAndCounted) {
  const Drive drive;
  DeskewRun run(oneLidar());
  run.rig(drive);
  for (const Odometry& o : drive.odometry(0.9, 2.0)) run.stage.push(o);
  auto empty = std::make_shared<Sweep>();
  empty->stamp = at(1.0);
  empty->frame = "lidar_left";
  run.stage.push(0, empty);
  run.stage.push(0, seeWall(drive, 1.1, 100, "lidar_that_nobody_calibrated").sweep);
  run.stage.push(0, seeWall(drive, 1.2, 100).sweep);
  run.finish();
  ASSERT_EQ(run.answers.size(), 3U);
  EXPECT_TRUE(run.answers[0].batched->batches.empty());
  EXPECT_TRUE(run.answers[1].batched->batches.empty());
  EXPECT_EQ(run.answers[1].batched->sweep->points.size(), 100U);
  EXPECT_FALSE(run.answers[2].batched->batches.empty());
  EXPECT_EQ(run.stage.counters().get("skipped sweep of lidar_left: empty"), 1U);
  EXPECT_EQ(run.stage.counters().get("skipped sweep of lidar_left: no extrinsic calibration for the frame"),
            1U);
}

TEST(DeskewOrder, BadOdometryIsSkippedNotUsed) {
  const Drive drive;
  DeskewRun run(oneLidar(200));
  run.rig(drive);
  const SeenSweep seen = seeWall(drive, 1.0, 200);
  for (Odometry o : drive.odometry(0.9, 1.2)) {
    run.stage.push(o);
    Odometry again = o;
    again.T_map_imu.translation.x() += 100.0;
    run.stage.push(again);  // same stamp
    o.stamp += kMillisecond;
    o.T_map_imu.translation.y() = std::numeric_limits<double>::quiet_NaN();
    run.stage.push(o);
  }
  run.stage.push(0, seen.sweep);
  run.finish();
  ASSERT_EQ(run.answers.size(), 1U);
  EXPECT_LT(worstError(inMap(*run.answers[0].batched), seen.truth_map), 5e-6);
  EXPECT_EQ(run.stage.counters().get("skipped odometry: not finite"), 31U);
  EXPECT_EQ(run.stage.counters().get("skipped odometry: stamp out of order"), 31U);
}

}  // namespace
}  // namespace atlas
