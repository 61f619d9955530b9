// SPDX-License-Identifier: MIT
#include "atlas/camera/compact_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "atlas/camera/projector.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

/// Two batches of three points, one without return.
std::shared_ptr<BatchedSweep> sixPoints() {
  const double nan = std::nan("");
  auto sweep = std::make_shared<BatchedSweep>(*sweepOf({point(1, 2, 3), point(nan, nan, nan), point(4, 5, 6),
                                                        point(7, 8, 9), point(0, 0, 0), point(-1, 0, 2)}));
  Batch later = sweep->batches[0];
  sweep->batches[0].count = 3;
  later.first = 3;
  later.count = 3;
  later.T_map_lidar.translation = {9, 0, 0};
  sweep->batches.push_back(later);
  return sweep;
}

TEST(CompactSweep, holdsTheReturnsOfEachBatch) {
  const CompactSweepPtr compact = compacted(*sixPoints());
  EXPECT_EQ(compact->stamp, kStart);
  EXPECT_EQ(compact->x, (std::vector<float>{1, 4, 7, -1}));
  EXPECT_EQ(compact->y, (std::vector<float>{2, 5, 8, 0}));
  EXPECT_EQ(compact->z, (std::vector<float>{3, 6, 9, 2}));
  ASSERT_EQ(compact->batches.size(), 2U);
  EXPECT_EQ(compact->batches[0].first, 0U);
  EXPECT_EQ(compact->batches[0].end, 2U);
  EXPECT_EQ(compact->batches[1].first, 2U);
  EXPECT_EQ(compact->batches[1].end, 4U);
  EXPECT_EQ(compact->batches[1].T_map_lidar.translation.x(), 9.0);
  EXPECT_FLOAT_EQ(compact->batches[0].bounds.min_range_m, std::sqrt(14.0F));
}

TEST(CompactSweep, sortsByBatchWhatIsStoredLaserByLaser) {
  const auto sweep = sixPoints();
  sweep->batch_of_point = {1, 0, 0, 1, 0, 0};
  const CompactSweepPtr compact = compacted(*sweep);
  EXPECT_EQ(compact->x, (std::vector<float>{4, -1, 1, 7}));
  EXPECT_EQ(compact->batches[0].end, 2U);
}

TEST(CompactSweep, emptyIsEmpty) {
  auto sweep = sixPoints();
  sweep->batches.clear();  // there was no pose
  EXPECT_TRUE(compacted(*sweep)->x.empty());
  const double nan = std::nan("");
  const CompactSweepPtr nothing = compacted(*sweepOf({point(nan, nan, nan)}));
  EXPECT_TRUE(nothing->x.empty());
  ASSERT_EQ(nothing->batches.size(), 1U);
  EXPECT_TRUE(nothing->batches[0].bounds.empty());
}

TEST(CompactSweep, isMadeOnceForAllWhoCountTheSweepAlike) {
  const auto sweep = sixPoints();
  const Origin origin{"lidar/batches", kStart, 3, {}};
  const CompactSweepPtr first = compactedOnce(*sweep, origin);
  EXPECT_EQ(compactedOnce(*sweep, origin), first);
  const CompactSweepPtr other = compactedOnce(*sweep, {"lidar/batches", kStart, 4, {}});
  EXPECT_EQ(other->origin.index, 4U);
  EXPECT_EQ(first->origin.index, 3U);
  BatchedSweep changed = *sweep;  // begins without
  changed.batches.clear();
  EXPECT_TRUE(compactedOnce(changed, origin)->x.empty());
}

/// One turn of a lidar at half a metre's distance from the camera: 100 batches of 32 lasers in firing order.
std::shared_ptr<BatchedSweep> turn(bool by_laser, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> range(1.0, 110.0);
  constexpr int kBatches = 100, kColumns = 10, kLasers = 32;
  auto sweep = std::make_shared<Sweep>();
  auto batched = std::make_shared<BatchedSweep>();
  std::vector<std::uint16_t> batch_of_point;
  for (int column = 0; column < kBatches * kColumns; ++column) {
    const double azimuth = -2.0 * M_PI * column / (kBatches * kColumns);
    for (int laser = 0; laser < kLasers; ++laser) {
      const double elevation = (-30.67 + 1.33 * laser) * M_PI / 180.0, r = range(random);
      sweep->points.push_back(point(r * std::cos(elevation) * std::cos(azimuth),
                                    r * std::cos(elevation) * std::sin(azimuth), r * std::sin(elevation)));
      batch_of_point.push_back(static_cast<std::uint16_t>(column / kColumns));
    }
    if (column % kColumns != 0) continue;
    Batch batch;
    batch.first = static_cast<std::uint32_t>(column * kLasers);
    batch.count = kColumns * kLasers;
    batch.T_map_lidar = {fromRollPitchYaw({0.01, -0.02, 0.001 * column}), {0.001 * column, 0.3, -0.2}};
    batched->batches.push_back(batch);
  }
  if (by_laser) batched->batch_of_point = batch_of_point;
  batched->sweep = sweep;
  return batched;
}

// Leaving whole batches out must not change what is seen: compared with a projection of every single point.
TEST(Projector, batchesOutOfViewAreLeftOutWithoutChangingTheResult) {
  for (const CameraInfo& info : budCameras()) {
    const Projector projector(CameraModel::fromInfo(info).value(), 0.5, 80.0);
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const auto sweep = turn(seed % 2 == 0, seed);
      const Pose T_map_imu = {fromRollPitchYaw({0.02, -0.03, 1.7 * seed}), {0.1, 0.2, 0.3}};
      const Pose T_camera_map = (T_map_imu * forwardCamera({0.5, 0.3, 0.1})).inverse();
      std::vector<std::array<float, 3>> expected, got;
      ProjectedPoint seen;
      forEachPoint(*sweep, [&](std::size_t i, const Batch& batch) {
        const auto T_camera_lidar = (T_camera_map * batch.T_map_lidar).matrix34f();
        if (projector.project(T_camera_lidar, sweep->sweep->points[i], seen))
          expected.push_back({seen.u, seen.v, seen.depth_m});
      });
      const CompactSweepPtr compact = compacted(*sweep);
      projector.projectSweep(*compact, T_camera_map, [&](const ProjectedPoint& p) {
        got.push_back({p.u, p.v, p.depth_m});
      });
      std::sort(got.begin(), got.end());
      std::sort(expected.begin(), expected.end());
      EXPECT_EQ(got, expected) << info.frame << " seed " << seed;
      std::size_t in_view = 0;
      for (std::size_t b = 0; b < 100; ++b) {
        const auto T_camera_lidar = (T_camera_map * sweep->batches[b].T_map_lidar).matrix34f();
        in_view += projector.maySee(T_camera_lidar, compact->batches[b].bounds) ? 1 : 0;
      }
      EXPECT_LT(in_view, 50U) << info.frame << " seed " << seed << ": that is what it is for";
    }
  }
}

}  // namespace
}  // namespace atlas::test
