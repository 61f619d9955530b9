// SPDX-License-Identifier: MIT
#include "atlas/grid/collision_risk.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

#include "grid_by_hand.hpp"

namespace atlas {
namespace {

EgoMotion egoAt(double x, double y, double speed_mps, double yaw_rate_radps = 0.0) {
  return {{x, y}, 0.0, speed_mps, yaw_rate_radps};
}

Object objectAt(double x, double y, double vx, double vy, double sigma = 0.05) {
  Object object;
  object.id = 7;
  object.existence = 1.0;
  object.position = {x, y, 0.8};
  object.size = {4.0, 1.8, 1.5};
  object.velocity_mps = {vx, vy, 0.0};
  for (std::size_t i = 0; i < 4; ++i) object.covariance[6 * i] = sigma * sigma;
  return object;
}

class RiskTest : public ::testing::Test {
 protected:
  RiskTest() : clusters_(grid_.geometry.cells(), 0) { params_.acceleration_mps2 = 0.1; }
  CollisionRisk risk(const EgoMotion& ego, const Objects& objects = {}) {
    return collisionRisk(ego, objects, grid_.geometry, grid_.cells, clusters_, params_);
  }
  /// Standing cells of the track with id 7.
  void putTrack(int column, int row, int width, int height) {
    grid_.put(column, row, width, height, {0.0, 0.0});
    for (int y = row; y < row + height; ++y) {
      for (int x = column; x < column + width; ++x) clusters_[grid_.geometry.indexOf(x, y)] = -7;
    }
  }
  GridByHand grid_;
  std::vector<std::int32_t> clusters_;
  RiskParams params_;
};

TEST_F(RiskTest, NoneOnAFreeRoad) {
  const CollisionRisk free = risk(egoAt(3.0, 10.0, 3.0));
  EXPECT_NEAR(free.total, 0.0, 1e-9);
  EXPECT_FALSE(free.expected_time_s);
  EXPECT_FALSE(free.object);
}

TEST_F(RiskTest, TheTimeToACarThatStandsAheadIsTheGapByTheSpeed) {
  Objects objects;
  objects.objects = {objectAt(16.0, 10.0, 0.0, 0.0)};
  objects.objects.front().is_static = true;
  putTrack(70, 45, 20, 10);
  const CollisionRisk risk_now = risk(egoAt(3.0, 10.0, 4.0), objects);  // front at 6, rear of the car at 14
  EXPECT_NEAR(risk_now.total, 0.95, 0.01) << "how sure its cells are";
  ASSERT_TRUE(risk_now.expected_time_s);
  EXPECT_NEAR(*risk_now.expected_time_s, 2.0, 0.15);
  ASSERT_TRUE(risk_now.object);
  EXPECT_EQ(*risk_now.object, 7U);
  EXPECT_NEAR(std::accumulate(risk_now.first_contact.begin(), risk_now.first_contact.end(), 0.0),
              risk_now.total, 1e-9);
}

TEST_F(RiskTest, AWallRoundACornerIsHitWhereItStandsAndNotWithinItsBox) {
  Objects objects;
  objects.objects = {objectAt(10.0, 10.0, 0.0, 0.0)};
  objects.objects.front().is_static = true;
  objects.objects.front().size = {20.0, 20.0, 2.0};  // around both walls, and the road between them
  putTrack(0, 90, 100, 2);                           // along the road, 8 m to the left
  putTrack(95, 20, 2, 70);                           // across, at x = 19
  EXPECT_LT(risk(egoAt(3.0, 10.0, 3.0), objects).total, 0.01) << "front at 15 m after 3 s";
  const CollisionRisk fast = risk(egoAt(3.0, 10.0, 6.0), objects);
  ASSERT_TRUE(fast.expected_time_s);
  EXPECT_NEAR(*fast.expected_time_s, 13.0 / 6.0, 0.15);
  EXPECT_EQ(fast.object, 7U);
}

TEST_F(RiskTest, ACarThatCrossesIsHitOnlyIfBothAreThereAtTheSameTime) {
  Objects meets, passes;
  meets.objects = {objectAt(10.0, 2.0, 0.0, 6.0)};    // at y = 10 after 1.3 s
  passes.objects = {objectAt(14.0, 16.0, 0.0, 6.0)};  // has gone by
  EXPECT_GT(risk(egoAt(3.0, 10.0, 4.0), meets).total, 0.9);
  EXPECT_LT(risk(egoAt(3.0, 10.0, 4.0), passes).total, 0.05);
}

TEST_F(RiskTest, UncertaintySpreadsTheTime) {
  Objects sure, unsure;
  sure.objects = {objectAt(13.0, 13.2, 0.0, 0.0, 0.02)};
  unsure.objects = {objectAt(13.0, 13.2, 0.0, 0.0, 1.0)};
  const double a = risk(egoAt(3.0, 10.0, 4.0), sure).total, b = risk(egoAt(3.0, 10.0, 4.0), unsure).total;
  EXPECT_LT(a, 0.05);
  EXPECT_GT(b, 0.2);
  EXPECT_LT(b, 1.0);
}

TEST_F(RiskTest, CellsThatBelongToNoObjectAreHitToo) {
  grid_.put(60, 45, 2, 10, {0.0, 0.0});  // at x = 12, in the way
  const CollisionRisk hit = risk(egoAt(3.0, 10.0, 4.0));
  EXPECT_NEAR(hit.total, 0.95, 0.01);
  EXPECT_FALSE(hit.object);
  EXPECT_NEAR(*hit.expected_time_s, 1.5, 0.15);
  const CollisionRisk turned = risk(egoAt(3.0, 10.0, 4.0, 1.2));  // turns away to the left before it
  EXPECT_LT(turned.total, 0.01);
}

TEST_F(RiskTest, WhatIsUnknownIsToldAndIsNoObstacle) {
  for (std::size_t i = 0; i < grid_.geometry.cells(); ++i) {
    grid_.cells.occupied[i] = 0.5F;
    grid_.cells.unknown[i] = 1.0F;
  }
  const CollisionRisk unknown = risk(egoAt(3.0, 10.0, 4.0));
  EXPECT_NEAR(unknown.unknown_share, 1.0, 1e-9);
  EXPECT_NEAR(unknown.total, 0.0, 1e-9);
}

TEST_F(RiskTest, RefusesBadParameters) {
  params_.bin_s = 0.0;
  EXPECT_THROW(validate(params_), std::invalid_argument);
  params_ = {};
  params_.horizon_s = -1.0;
  EXPECT_THROW(validate(params_), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
