// SPDX-License-Identifier: MIT
#include "atlas/base/trajectory.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace atlas {
namespace {

Pose at(double x, double yaw) { return {fromRollPitchYaw({0, 0, yaw}), {x, 0, 0}}; }

TEST(Trajectory, W2_InterpolationIsNotMirrored) {
  // W2: the published program mirrored the interpolation in time.
  Trajectory trajectory;
  trajectory.push({1000, at(0.0, 0.0)});
  trajectory.push({2000, at(10.0, 1.0)});
  const Outcome<Pose> pose = trajectory.at(1100);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation.x(), 1.0, 1e-12);
  EXPECT_NEAR(toRollPitchYaw(pose->rotation).yaw, 0.1, 1e-12);
}

TEST(Trajectory, W3_AfterTheNewestThereIsNoPose) {
  // W3: the published program answered 9.2e10 m.
  Trajectory trajectory;
  trajectory.push({1000, at(0.0, 0.0)});
  trajectory.push({2000, at(10.0, 1.0)});
  const Outcome<Pose> pose = trajectory.at(2001);
  ASSERT_FALSE(pose);
  EXPECT_EQ(pose.reason(), Reason::kPoseNotReached);
}

TEST(Trajectory, W12_BeforeTheFirstAndWhenEmptyThereIsNoPose) {
  Trajectory trajectory;
  EXPECT_EQ(trajectory.at(5).reason(), Reason::kNoPoseYet);
  trajectory.push({1000, at(0.0, 0.0)});
  EXPECT_EQ(trajectory.at(999).reason(), Reason::kNoPoseYet);
}

TEST(Trajectory, ExactAtStoredStamps) {
  Trajectory trajectory;
  for (int i = 0; i < 5; ++i) trajectory.push({1000 * i, at(0.1 * i, 0.3 * i)});
  for (int i = 0; i < 5; ++i) {
    const Outcome<Pose> pose = trajectory.at(1000 * i);
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->translation, at(0.1 * i, 0.3 * i).translation);
    EXPECT_EQ(pose->rotation.coeffs(), at(0.1 * i, 0.3 * i).rotation.coeffs());
  }
}

TEST(Trajectory, GapIsNotBridged) {
  Trajectory trajectory(100);
  trajectory.push({0, at(0.0, 0.0)});
  trajectory.push({100, at(1.0, 0.0)});
  trajectory.push({201, at(2.0, 0.0)});
  EXPECT_TRUE(trajectory.at(50));
  EXPECT_EQ(trajectory.at(150).reason(), Reason::kPoseGap);
  EXPECT_TRUE(trajectory.at(201)) << "a stored pose is known whatever the gap before it";
}

TEST(Trajectory, StampsMustGrow) {
  Trajectory trajectory;
  trajectory.push({1000, {}});
  EXPECT_THROW(trajectory.push({1000, {}}), std::invalid_argument);
  EXPECT_THROW(trajectory.push({999, {}}), std::invalid_argument);
}

TEST(Trajectory, ForgettingKeepsWhatLaterQueriesNeed) {
  Trajectory trajectory;
  for (int i = 0; i <= 10; ++i) trajectory.push({100 * i, at(i, 0.0)});
  trajectory.forgetBefore(450);
  EXPECT_EQ(trajectory.poses().front().stamp, 400);
  ASSERT_TRUE(trajectory.at(450));
  EXPECT_NEAR(trajectory.at(450)->translation.x(), 4.5, 1e-12);
  trajectory.forgetBefore(5000);
  EXPECT_EQ(trajectory.poses().size(), 1U);
  EXPECT_TRUE(trajectory.at(1000));
}

}  // namespace
}  // namespace atlas
