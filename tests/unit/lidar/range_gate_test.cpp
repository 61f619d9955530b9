// SPDX-License-Identifier: MIT
#include "atlas/lidar/range_gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace atlas {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

LidarPoint at(float x, float y, float z) {
  LidarPoint p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.intensity = 7.0F;
  return p;
}

TEST(RangeGate, BoundsBelongToTheBelievedRange) {
  auto sweep = std::make_shared<Sweep>();
  sweep->points = {at(0.99F, 0, 0), at(1.0F, 0, 0), at(0, -120.0F, 0), at(0, 0, 120.1F), at(3, 4, 0)};
  const GatedSweep gated = gateByRange(sweep, 1.0, 120.0);
  const auto& points = gated.sweep->points;
  ASSERT_EQ(points.size(), 5U);
  EXPECT_TRUE(std::isnan(points[0].x) && std::isnan(points[0].y) && std::isnan(points[0].z));
  EXPECT_EQ(points[1].x, 1.0F);
  EXPECT_EQ(points[2].y, -120.0F);
  EXPECT_TRUE(std::isnan(points[3].z));
  EXPECT_EQ(points[4].y, 4.0F);
  EXPECT_EQ(gated.gated, 2U);
  EXPECT_EQ(points[0].intensity, 7.0F) << "only the position is unknown";
  EXPECT_EQ(sweep->points[0].x, 0.99F) << "the input is shared and stays as it was";
}

TEST(RangeGate, RangeIsEuclideanInThreeDimensions) {
  // the published program: |x| + |y| > 2: a point 1.5 m above the sensor was dropped, one at (1.2, 1.2) kept
  auto sweep = std::make_shared<Sweep>();
  sweep->points = {at(0, 0, 2.5F), at(1.2F, 1.2F, 0)};
  const GatedSweep gated = gateByRange(sweep, 2.0, 120.0);
  EXPECT_EQ(gated.sweep->points[0].z, 2.5F);
  EXPECT_TRUE(std::isnan(gated.sweep->points[1].x));
}

TEST(RangeGate, ZeroIsNoReturnEvenWithoutMinimum) {
  auto sweep = std::make_shared<Sweep>();
  sweep->points = {at(0, 0, 0), at(0.01F, 0, 0)};
  const GatedSweep gated = gateByRange(sweep, 0.0, 120.0);
  EXPECT_TRUE(std::isnan(gated.sweep->points[0].x));
  EXPECT_EQ(gated.sweep->points[1].x, 0.01F);
}

TEST(RangeGate, HalfKnownPointsBecomeUnknown) {
  auto sweep = std::make_shared<Sweep>();
  sweep->points = {at(kNan, 5, 5), at(std::numeric_limits<float>::infinity(), 0, 0), at(kNan, kNan, kNan)};
  const GatedSweep gated = gateByRange(sweep, 1.0, 120.0);
  for (const LidarPoint& p : gated.sweep->points)
    EXPECT_TRUE(std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z));
  EXPECT_EQ(gated.gated, 0U) << "they were no returns before";
}

TEST(RangeGate, NothingToDoIsNoCopy) {
  auto sweep = std::make_shared<Sweep>();
  sweep->points = {at(5, 0, 0), at(kNan, kNan, kNan)};
  EXPECT_EQ(gateByRange(sweep, 1.0, 120.0).sweep, sweep);
}

}  // namespace
}  // namespace atlas
