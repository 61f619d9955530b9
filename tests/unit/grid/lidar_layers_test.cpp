// SPDX-License-Identifier: MIT
#include "atlas/grid/lidar_layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace atlas {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// `rings` lasers 1 degree apart from -8 degrees up, 360 points each, at 10 m; column by column.
BatchedSweep sweepOf(int rings, const std::vector<int>& missing_columns = {}) {
  auto sweep = std::make_shared<Sweep>();
  for (int column = 0; column < 360; ++column) {
    for (int ring = 0; ring < rings; ++ring) {
      const double azimuth = column * kDegree, elevation = (ring - 8) * kDegree;
      LidarPoint p;
      p.x = static_cast<float>(10.0 * std::cos(azimuth));
      p.y = static_cast<float>(10.0 * std::sin(azimuth));
      p.z = static_cast<float>(10.0 * std::tan(elevation));
      p.ring = static_cast<std::uint16_t>(ring);
      for (const int gone : missing_columns) {
        if (gone == column) p.x = p.y = p.z = kNan;
      }
      sweep->points.push_back(p);
    }
  }
  BatchedSweep batched;
  batched.sweep = sweep;
  batched.T_map_lidar.translation = {100.0, 50.0, 2.0};
  Batch all;
  all.count = static_cast<std::uint32_t>(sweep->points.size());
  all.T_map_lidar = batched.T_map_lidar;
  batched.batches = {all};
  return batched;
}

TEST(LidarLayers, PicksTheLasersNearestToTheHorizon) {
  LayerParams params;
  params.count = 4;
  params.spacing_rad = kDegree;
  params.middle_rad = -0.5 * kDegree;
  const LidarLayers layers = pickLayers(sweepOf(16), params);
  ASSERT_EQ(layers.layers.size(), 4U);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(layers.layers[i].elevation_rad, (i - 2) * kDegree, 1e-5);
  ASSERT_EQ(layers.layers[0].beams.size(), 360U);
  EXPECT_NEAR(layers.layers[0].beams[90].range_m, 10.0, 1e-4);
  EXPECT_NEAR(layers.layers[0].beams[90].azimuth_rad, M_PI / 2.0, 1e-5);
  EXPECT_NEAR(layers.layers[2].beams[5].height_m, 2.0, 1e-5);
}

TEST(LidarLayers, PicksAskedElevationsEachLaserOnceAndNoneThatIsTooFar) {
  LayerParams params;
  params.elevations_rad = {-3.1 * kDegree, -3.2 * kDegree, 20.0 * kDegree, 4.0 * kDegree};
  const LidarLayers layers = pickLayers(sweepOf(16), params);
  ASSERT_EQ(layers.layers.size(), 3U);  // -4 or -3 for the two first, 4; nothing at 20
  EXPECT_NEAR(layers.layers[1].elevation_rad, -3.0 * kDegree, 1e-5);
  EXPECT_NEAR(layers.layers[2].elevation_rad, 4.0 * kDegree, 1e-5);
}

TEST(LidarLayers, BeamsWithoutReturnLieBetweenTheirNeighbours) {
  LayerParams params;
  params.elevations_rad = {0.0};
  const LidarLayers layers = pickLayers(sweepOf(16, {100, 101, 102}), params);
  ASSERT_EQ(layers.layers[0].beams.size(), 360U);
  for (int column = 100; column < 103; ++column) {
    const LayerBeam& beam = layers.layers[0].beams[static_cast<std::size_t>(column)];
    EXPECT_TRUE(std::isnan(beam.range_m));
    EXPECT_NEAR(beam.azimuth_rad, column * kDegree, 1e-4);
  }
}

TEST(LidarLayers, NothingWithoutPoseOrReturns) {
  BatchedSweep without_pose = sweepOf(16);
  without_pose.batches.clear();
  EXPECT_TRUE(pickLayers(without_pose, LayerParams{}).layers.empty());
  BatchedSweep empty = sweepOf(0);
  EXPECT_TRUE(pickLayers(empty, LayerParams{}).layers.empty());
  std::vector<int> all(360);
  for (int i = 0; i < 360; ++i) all[static_cast<std::size_t>(i)] = i;
  EXPECT_TRUE(pickLayers(sweepOf(16, all), LayerParams{}).layers.empty());
}

TEST(LidarLayers, RefusesBadParameters) {
  LayerParams params;
  params.count = 0;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.spacing_rad = 0.0;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.elevations_rad = {2.0};
  EXPECT_THROW(validate(params), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
