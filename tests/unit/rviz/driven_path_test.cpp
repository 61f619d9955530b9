// SPDX-License-Identifier: MIT
// The path grows by steps of space, not of time, is bounded, and begins anew when time goes back.
#include "driven_path.hpp"

#include <gtest/gtest.h>

namespace {

atlas::Odometry odometryAt(atlas::Stamp stamp, double x_m, double speed_mps = 0.0) {
  atlas::Odometry odometry;
  odometry.stamp = stamp;
  odometry.T_map_imu.translation = {x_m, 0, 0};
  odometry.velocity_imu_mps = {speed_mps, 0, 0};
  return odometry;
}

TEST(DrivenPath, StandingAddsNothing) {
  atlas_rviz::DrivenPath path;
  EXPECT_TRUE(path.add(odometryAt(1, 0)));
  for (atlas::Stamp t = 2; t < 100; ++t) EXPECT_FALSE(path.add(odometryAt(t, 0.01)));
  EXPECT_EQ(path.points().size(), 1U);
  EXPECT_EQ(path.stamp(), 99);
}

TEST(DrivenPath, GrowsExactlyAtTheStep) {
  atlas_rviz::DrivenPath path;
  path.add(odometryAt(1, 0));
  EXPECT_FALSE(path.add(odometryAt(2, 0.4999)));
  EXPECT_TRUE(path.add(odometryAt(3, 0.5, 7.0)));
  ASSERT_EQ(path.points().size(), 2U);
  EXPECT_EQ(path.points().back().position.x(), 0.5);
  EXPECT_EQ(path.points().back().speed_mps, 7.0);
}

TEST(DrivenPath, TimeGoingBackClearsIt) {
  atlas_rviz::DrivenPath path;
  path.add(odometryAt(100, 0));
  path.add(odometryAt(101, 1));
  EXPECT_TRUE(path.add(odometryAt(50, 0.9)));  // nearer than a step to the old end
  ASSERT_EQ(path.points().size(), 1U);
  EXPECT_EQ(path.points()[0].position.x(), 0.9);
}

TEST(DrivenPath, MemoryIsBoundedAndBothEndsStay) {
  atlas_rviz::DrivenPath path;
  constexpr int kAdded = 50'000;
  for (int i = 0; i < kAdded; ++i) path.add(odometryAt(i, i));
  EXPECT_LE(path.points().size(), atlas_rviz::DrivenPath::kMostPoints);
  EXPECT_GE(path.points().size(), atlas_rviz::DrivenPath::kMostPoints / 2);
  EXPECT_EQ(path.points().front().position.x(), 0);
  EXPECT_EQ(path.points().back().position.x(), kAdded - 1);
  for (std::size_t i = 1; i < path.points().size(); ++i) {
    ASSERT_GT(path.points()[i].position.x(), path.points()[i - 1].position.x());
  }
}

}  // namespace
