// SPDX-License-Identifier: MIT
#include "atlas/lidar/aggregate_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

using test::at;

/// One point at (x, 0, 0) in map, measured 10 ms after the stamp.
BatchedSweepPtr onePoint(double stamp_s, double x) {
  auto sweep = std::make_shared<Sweep>();
  sweep->stamp = at(stamp_s);
  LidarPoint p;
  p.x = 0.0F;
  p.time = 0.01F;
  sweep->points = {p};
  auto batched = std::make_shared<BatchedSweep>();
  batched->stamp = sweep->stamp;
  batched->sweep = sweep;
  batched->batches = {{0, 1, sweep->stamp, {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0, 0)}}};
  return batched;
}

AggregateParams everyPoint() {
  AggregateParams params;
  params.voxel_m = 0.0;
  return params;
}

struct Clouds {
  explicit Clouds(const AggregateParams& params) : stage(params) {
    stage.on_cloud = [this](const MapCloudPtr& cloud) { clouds.push_back(cloud); };
  }
  void finish() {
    for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  }
  AggregateStage stage;
  std::vector<MapCloudPtr> clouds;
};

TEST(Aggregate, CloudsOnMultiplesOfThePeriodWithTheWindowBefore) {
  Clouds run(everyPoint());
  for (int i = 0; i <= 25; ++i) {
    run.stage.push(0, onePoint(0.1 * i, i));
    run.stage.push(1, onePoint(0.1 * i + 0.05, 100 + i));
  }
  run.finish();
  ASSERT_EQ(run.clouds.size(), 4U);
  EXPECT_EQ(run.clouds[0]->stamp, at(0.0));
  EXPECT_EQ(run.clouds[0]->points.size(), 1U);
  EXPECT_EQ(run.clouds[1]->stamp, at(1.0));
  ASSERT_EQ(run.clouds[1]->points.size(), 20U) << "stamps in (0, 1]: 10 of each lidar";
  EXPECT_EQ(run.clouds[1]->points.front().x, 100.0F);
  EXPECT_EQ(run.clouds[1]->points.back().x, 10.0F);
  EXPECT_NEAR(run.clouds[1]->points.back().time, 0.01, 1e-6);
  EXPECT_NEAR(run.clouds[1]->points.front().time, -0.95 + 0.01, 1e-6);
  EXPECT_EQ(run.clouds[3]->stamp, at(3.0)) << "what was left at the end";
}

TEST(Aggregate, WatermarksDecideWhenNotWhat) {
  Clouds plain(everyPoint()), watched(everyPoint());
  for (int i = 0; i <= 12; ++i) {
    plain.stage.push(0, onePoint(0.1 * i, i));
    watched.stage.push(0, onePoint(0.1 * i, i));
    watched.stage.advance(1, at(0.1 * i));
    watched.stage.advance(0, at(0.1 * i + 0.05));
  }
  EXPECT_TRUE(plain.clouds.empty()) << "the second lidar could still send";
  EXPECT_EQ(watched.clouds.size(), 2U) << "as soon as nothing can come any more";
  watched.stage.advance(0, at(100.0));  // far beyond: no clouds for the empty seconds
  watched.stage.advance(1, at(100.0));
  plain.finish();
  watched.finish();
  ASSERT_EQ(plain.clouds.size(), 3U);
  ASSERT_EQ(watched.clouds.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(plain.clouds[i]->stamp, watched.clouds[i]->stamp);
    EXPECT_EQ(plain.clouds[i]->points.size(), watched.clouds[i]->points.size());
  }
}

TEST(Aggregate, ArrivalOrderHasNoInfluence) {
  std::string expected;
  for (unsigned seed = 0; seed < 25; ++seed) {
    Clouds run(everyPoint());
    std::mt19937 random(seed);
    std::vector<std::size_t> turns;
    for (std::size_t lidar = 0; lidar < 2; ++lidar) turns.insert(turns.end(), 25, lidar);
    if (seed > 0) std::shuffle(turns.begin(), turns.end(), random);
    std::array<int, 2> next{};
    for (const std::size_t lidar : turns) {
      const int i = next[lidar]++;
      run.stage.push(lidar,
                     onePoint(0.1 * i, 100.0 * static_cast<double>(lidar) + i));  // ties between the lidars
      if (seed % 3 == 2) run.stage.advance(lidar, at(0.1 * i));
    }
    run.finish();
    std::string all;
    for (const MapCloudPtr& cloud : run.clouds) {
      all += std::to_string(cloud->stamp) + ":";
      for (const LidarPoint& p : cloud->points)
        all += " " + std::to_string(p.x) + "@" + std::to_string(p.time);
    }
    if (seed == 0) expected = all;
    EXPECT_EQ(all, expected) << "seed " << seed;
  }
}

TEST(Aggregate, ThinnedToOnePointPerVoxelAndWithoutNan) {
  AggregateParams params;
  params.voxel_m = 0.5;
  Clouds run(params);
  for (int i = 1; i <= 10; ++i) run.stage.push(0, onePoint(0.1 * i, i < 5 ? 0.1 : 7.1));
  auto nan = std::make_shared<BatchedSweep>(*onePoint(1.0, 3.0));
  auto sweep = std::make_shared<Sweep>(*nan->sweep);
  sweep->points[0].x = std::numeric_limits<float>::quiet_NaN();
  nan->sweep = sweep;
  run.stage.push(1, nan);
  run.finish();
  ASSERT_EQ(run.clouds.size(), 1U);
  ASSERT_EQ(run.clouds[0]->points.size(), 2U);
}

TEST(Aggregate, SweepsWithoutPoseGiveNoCloud) {
  Clouds run(everyPoint());
  auto batched = std::make_shared<BatchedSweep>(*onePoint(0.5, 0));
  batched->batches.clear();
  run.stage.push(0, batched);
  run.finish();
  EXPECT_TRUE(run.clouds.empty());
  EXPECT_EQ(run.stage.counters().get("sweeps without pose"), 1U);
}

TEST(Aggregate, RefusesParametersByName) {
  AggregateParams params;
  params.period_s = 0.0;
  EXPECT_THROW(AggregateStage{params}, std::invalid_argument);
  params = {};
  params.lidars.clear();
  EXPECT_THROW(AggregateStage{params}, std::invalid_argument);
}

TEST(SweepWindow, HoldsWhatIsYoungerThanItsLength) {
  SweepWindow window(kSecond);
  for (int i = 0; i <= 10; ++i) window.push(onePoint(0.1 * i, i));
  window.forget(at(1.0));
  ASSERT_EQ(window.sweeps().size(), 10U) << "(now - length, now]";
  EXPECT_EQ(window.sweeps().front()->stamp, at(0.1));
}

}  // namespace
}  // namespace atlas
