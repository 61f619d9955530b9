// SPDX-License-Identifier: MIT
#include "atlas/camera/batch_bounds.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "atlas/camera/projector.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

TEST(BatchBounds, byHand) {
  BatchBounds bounds;
  EXPECT_TRUE(bounds.empty());
  bounds.add(point(3, 4, 0));
  bounds.add(point(0, 10, 0));
  bounds.add(point(std::nan(""), 1, 0));  // no return
  bounds.add(point(0, 0, 0));             // neither
  ASSERT_FALSE(bounds.empty());
  EXPECT_EQ(bounds.min_range_m, 5.0F);
  EXPECT_EQ(bounds.max_range_m, 10.0F);
  EXPECT_TRUE(bounds.low_direction.isApprox(Eigen::Vector3f(0.0F, 0.8F, 0.0F)));
  EXPECT_TRUE(bounds.high_direction.isApprox(Eigen::Vector3f(0.6F, 1.0F, 0.0F)));
  // y - 20: the best is 10 * 1 - 20; -y + 1: the best is 5 * -0.8 + 1
  EXPECT_FLOAT_EQ(bounds.largest({0, 1, 0}, -20.0F), -10.0F);
  EXPECT_FLOAT_EQ(bounds.largest({0, -1, 0}, 1.0F), -3.0F);
}

TEST(BatchBounds, nothingInsideExceedsTheLargest) {
  std::mt19937 random(5);
  std::normal_distribution<float> n;
  for (int run = 0; run < 200; ++run) {
    const Eigen::Vector3f middle = 20.0F * Eigen::Vector3f(n(random), n(random), n(random));
    std::vector<Eigen::Vector3f> points;
    BatchBounds bounds;
    for (int i = 0; i < 30; ++i) {
      points.push_back(middle + 3.0F * Eigen::Vector3f(n(random), n(random), n(random)));
      bounds.add(point(points.back().x(), points.back().y(), points.back().z()));
    }
    const Eigen::Vector3f normal(n(random), n(random), n(random));
    for (const Eigen::Vector3f& p : points)
      EXPECT_LE(normal.dot(p) + 1.5F, bounds.largest(normal, 1.5F) + 1e-3F);
  }
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
      const BoundedSweepPtr bounded = withBounds(sweep);
      projector.projectSweep(*bounded, T_camera_map, [&](const ProjectedPoint& p) {
        got.push_back({p.u, p.v, p.depth_m});
      });
      EXPECT_EQ(got, expected) << info.frame << " seed " << seed;
      std::size_t in_view = 0;
      for (std::size_t b = 0; b < 100; ++b) {
        const auto T_camera_lidar = (T_camera_map * sweep->batches[b].T_map_lidar).matrix34f();
        in_view += projector.maySee(T_camera_lidar, bounded->bounds[b]) ? 1 : 0;
      }
      EXPECT_LT(in_view, 50U) << info.frame << " seed " << seed << ": that is what it is for";
    }
  }
}

}  // namespace
}  // namespace atlas::test
