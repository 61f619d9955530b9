// SPDX-License-Identifier: MIT
#include "atlas/lidar/batching.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

using test::at;

std::shared_ptr<Sweep> sweepAt(const std::vector<float>& times) {
  auto sweep = std::make_shared<Sweep>();
  sweep->stamp = at(1.0);
  for (const float time : times) {
    LidarPoint p;
    p.x = 10.0F;
    p.time = time;
    sweep->points.push_back(p);
  }
  return sweep;
}

/// 10 m/s along x: x = 10 t.
Trajectory straight() {
  Trajectory trajectory;
  for (int i = 0; i <= 40; ++i)
    trajectory.push({at(0.05 * i), {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.5 * i, 0, 0)}});
  return trajectory;
}

TEST(SpanOf, HoldsTheStampAndAllPoints) {
  const Outcome<SweepSpan> after = spanOf(*sweepAt({0.01F, 0.02F}));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->first, at(1.0));
  EXPECT_NEAR(static_cast<double>(after->last - at(1.02)), 0.0, 2.0);  // float: 1 ns at 0.02 s
  EXPECT_TRUE(after->time_ordered);
  const Outcome<SweepSpan> around = spanOf(*sweepAt({-0.05F, 0.05F, 0.04F}));
  EXPECT_NEAR(static_cast<double>(around->first - at(0.95)), 0.0, 4.0);
  EXPECT_FALSE(around->time_ordered);
  EXPECT_TRUE(spanOf(*sweepAt({0.0F, 0.0F, 0.0F}))->time_ordered) << "lasers that fire together";
}

TEST(SpanOf, NoSpanWithoutTimes) {
  EXPECT_EQ(spanOf(*sweepAt({})).reason(), Reason::kEmpty);
  EXPECT_EQ(spanOf(*sweepAt({0.0F, std::numeric_limits<float>::quiet_NaN()})).reason(), Reason::kNotFinite);
  EXPECT_EQ(spanOf(*sweepAt({0.0F, 1.6e9F})).reason(), Reason::kNotFinite)
      << "absolute time in a relative field";
}

TEST(CutIntoBatches, WorkedExample) {
  // two batches of two points, mean times 1.005 and 1.025 s: x_imu = 10.05 and 10.25 m; lidar 2 m ahead of
  // the imu
  const auto sweep = sweepAt({0.0F, 0.01F, 0.02F, 0.03F});
  const auto batched = cutIntoBatches(sweep, *spanOf(*sweep), 2, straight(),
                                      {Eigen::Quaterniond::Identity(), Eigen::Vector3d(2, 0, 0)});
  ASSERT_TRUE(batched);
  ASSERT_EQ(batched->batches.size(), 2U);
  EXPECT_EQ(batched->batches[0].first, 0U);
  EXPECT_EQ(batched->batches[0].count, 2U);
  EXPECT_EQ(batched->batches[1].first, 2U);
  EXPECT_NEAR(batched->batches[0].T_map_lidar.translation.x(), 12.05, 1e-7);
  EXPECT_NEAR(batched->batches[1].T_map_lidar.translation.x(), 12.25, 1e-7);
  EXPECT_NEAR(batched->T_map_lidar.translation.x(), 12.0, 1e-9);
  EXPECT_TRUE(batched->batch_of_point.empty());
}

TEST(CutIntoBatches, EveryPointInExactlyOneRange) {
  for (const std::size_t points : {1U, 2U, 9U, 10U, 11U, 1000U}) {
    const auto sweep = sweepAt(std::vector<float>(points, 0.05F));
    const auto batched = cutIntoBatches(sweep, *spanOf(*sweep), 10, straight(), {});
    ASSERT_TRUE(batched);
    EXPECT_EQ(batched->batches.size(), std::min<std::size_t>(10, points));
    std::size_t next = 0;
    forEachPoint(*batched, [&](std::size_t i, const Batch&) { EXPECT_EQ(i, next++); });
    EXPECT_EQ(next, points);
  }
}

TEST(CutIntoBatches, UnorderedTimesAreGroupedByTime) {
  std::vector<float> times(997);
  for (std::size_t i = 0; i < times.size(); ++i)
    times[i] = static_cast<float>(0.1 * static_cast<double>(i) / 997.0 - 0.05);
  std::mt19937 random(5);
  std::shuffle(times.begin(), times.end(), random);
  const auto sweep = sweepAt(times);
  const auto batched = cutIntoBatches(sweep, *spanOf(*sweep), 50, straight(), {});
  ASSERT_TRUE(batched);
  ASSERT_EQ(batched->batch_of_point.size(), times.size());
  Stamp last = kBeginOfTime;
  for (const Batch& batch : batched->batches) {
    EXPECT_GT(batch.stamp, last) << "batches in order of time";
    last = batch.stamp;
  }
  std::size_t visited = 0;
  forEachPoint(*batched, [&](std::size_t i, const Batch& batch) {
    EXPECT_EQ(i, visited++) << "in the order of the sweep";
    // a bin of 2 ms holds the point and its mean
    EXPECT_LE(std::abs(toSeconds(batch.stamp - sweep->stamp) - static_cast<double>(times[i])),
              0.1 / 50 + 1e-6);
  });
  EXPECT_EQ(visited, times.size());
}

TEST(CutIntoBatches, EmptyBinsAreLeftOut) {
  const auto sweep = sweepAt({0.1F, 0.0F, 0.1F, 0.001F});
  const auto batched = cutIntoBatches(sweep, *spanOf(*sweep), 10, straight(), {});
  ASSERT_TRUE(batched);
  ASSERT_EQ(batched->batches.size(), 2U);
  EXPECT_EQ(batched->batch_of_point, (std::vector<std::uint16_t>{1, 0, 1, 0}));
  EXPECT_NEAR(batched->batches[1].T_map_lidar.translation.x(), 11.0, 1e-6);
  EXPECT_EQ(batched->batches[0].count, 0U) << "there is no range to iterate over by mistake";
}

TEST(CutIntoBatches, W3_W12_NoPoseIsAReasonNotAnIdentity) {
  const auto sweep = sweepAt({0.0F, 0.1F});
  Trajectory late, early, gap;
  late.push({at(1.05), {}});
  late.push({at(1.2), {}});
  early.push({at(0.9), {}});
  early.push({at(1.05), {}});
  gap.push({at(0.9), {}});
  gap.push({at(2.0), {}});
  const SweepSpan span = *spanOf(*sweep);
  EXPECT_EQ(cutIntoBatches(sweep, span, 10, late, {}).reason(), Reason::kNoPoseYet);
  EXPECT_EQ(cutIntoBatches(sweep, span, 10, early, {}).reason(), Reason::kPoseNotReached);
  EXPECT_EQ(cutIntoBatches(sweep, span, 10, gap, {}).reason(), Reason::kPoseGap);
}

}  // namespace
}  // namespace atlas
