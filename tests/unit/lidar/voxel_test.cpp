// SPDX-License-Identifier: MIT
#include "atlas/lidar/voxel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>

namespace atlas {
namespace {

LidarPoint at(float x, float y, float z, float intensity = 0) {
  LidarPoint p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.intensity = intensity;
  return p;
}

TEST(VoxelOf, FloorsTowardsMinusInfinity) {
  const auto key = voxelOf(-0.1, 0.1, -0.2, 0.2);
  ASSERT_TRUE(key);
  EXPECT_EQ(key->x, -1);
  EXPECT_EQ(key->y, 0);
  EXPECT_EQ(key->z, -1) << "a voxel owns its lower bound";
}

TEST(VoxelOf, NothingOutsideTheNumbers) {
  EXPECT_FALSE(voxelOf(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0.2));
  EXPECT_FALSE(voxelOf(0, std::numeric_limits<double>::infinity(), 0, 0.2));
  EXPECT_FALSE(voxelOf(0, 0, -1e10, 0.2));
  // PCL's voxel grid gave up (returned its input) beyond 2^31 cells in all; 1000 km are no problem
  // here
  EXPECT_TRUE(voxelOf(1e6, -1e6, 1e6, 0.01));
}

TEST(VoxelFilter, FirstPointOfEachVoxelInOrderOfTheInput) {
  const auto thin =
      voxelFiltered({at(5, 5, 5, 1), at(0.1F, 0.1F, 0.1F, 2), at(5.1F, 5.1F, 5.1F, 3), at(-1, 0, 0, 4)}, 0.5);
  ASSERT_EQ(thin.size(), 3U);
  EXPECT_EQ(thin[0].intensity, 1.0F);
  EXPECT_EQ(thin[1].intensity, 2.0F);
  EXPECT_EQ(thin[2].intensity, 4.0F);
}

TEST(VoxelFilter, CentroidByHand) {
  const auto thin = voxelFiltered({at(0.1F, 0, 0, 10), at(0.3F, 0.2F, 0, 20), at(0.2F, 0.4F, 0.3F, 60)}, 0.5,
                                  VoxelPoint::kCentroid);
  ASSERT_EQ(thin.size(), 1U);
  EXPECT_FLOAT_EQ(thin[0].x, 0.2F);
  EXPECT_FLOAT_EQ(thin[0].y, 0.2F);
  EXPECT_FLOAT_EQ(thin[0].z, 0.1F);
  EXPECT_FLOAT_EQ(thin[0].intensity, 30.0F);
}

TEST(VoxelFilter, SameAsAMap) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-20.0F, 20.0F);
  std::vector<LidarPoint> points;
  for (int i = 0; i < 50000; ++i)
    points.push_back(at(coordinate(random), coordinate(random), coordinate(random) / 10, float(i)));
  points[100].y = std::numeric_limits<float>::quiet_NaN();
  std::map<std::tuple<int, int, int>, float> seen;
  std::vector<float> expected;
  for (const LidarPoint& p : points) {
    if (!(p.y == p.y)) continue;
    const auto key = std::make_tuple(int(std::floor(double(p.x) / 0.7)), int(std::floor(double(p.y) / 0.7)),
                                     int(std::floor(double(p.z) / 0.7)));
    if (seen.emplace(key, p.intensity).second) expected.push_back(p.intensity);
  }
  const auto thin = voxelFiltered(points, 0.7);
  ASSERT_EQ(thin.size(), expected.size());
  for (std::size_t i = 0; i < thin.size(); ++i) ASSERT_EQ(thin[i].intensity, expected[i]);
}

TEST(VoxelFilter, RefusesAnEdgeOfZero) {
  EXPECT_THROW(VoxelFilter(0.0, VoxelPoint::kFirst), std::invalid_argument);
  EXPECT_TRUE(voxelFiltered({}, 0.5).empty());
}

// The filter remembers the last voxel of each ring (modulo 128): that must not show.
TEST(VoxelFilter, RingsDoNotChangeWhatIsKept) {
  std::vector<LidarPoint> points;
  for (int i = 0; i < 20000; ++i) {
    const auto wave = static_cast<float>(std::sin(0.37 * i));
    points.push_back({5.0F * wave, 0.001F * static_cast<float>(i), wave * wave, static_cast<float>(i), 0,
                      static_cast<std::uint16_t>(i * 7 % 300), 0});
  }
  std::vector<LidarPoint> without_rings = points;
  for (LidarPoint& p : without_rings) p.ring = 0;
  for (const VoxelPoint keep : {VoxelPoint::kFirst, VoxelPoint::kCentroid}) {
    const auto a = voxelFiltered(points, 0.5, keep), b = voxelFiltered(without_rings, 0.5, keep);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].intensity, b[i].intensity);
      EXPECT_EQ(a[i].x, b[i].x);
    }
  }
}

}  // namespace
}  // namespace atlas
