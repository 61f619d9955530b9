// SPDX-License-Identifier: MIT
#include "atlas/camera/pose_history.hpp"

#include <gtest/gtest.h>

#include "scene.hpp"

namespace atlas::test {
namespace {

TEST(PoseHistory, waitsUntilThePoseIsKnown) {
  PoseHistory history(0.5);
  Counters counters;
  EXPECT_FALSE(history.at(kStart, kStart - 1));
  history.push(odometry(kStart - 10 * kMillisecond, {0, 0, 0}), counters);
  EXPECT_FALSE(history.at(kStart, kStart));
  history.push(odometry(kStart + 10 * kMillisecond, {2, 0, 0}), counters);
  const auto pose = history.at(kStart, kStart);
  ASSERT_TRUE(pose && *pose);
  EXPECT_NEAR(pose->value().translation.x(), 1.0, 1e-12);
}

TEST(PoseHistory, givesUpOnceNoPoseCanComeInTime) {
  PoseHistory history(0.5);
  Counters counters;
  history.push(odometry(kStart), counters);
  EXPECT_FALSE(history.at(kStart + 1, kStart + kSecond / 2));
  const auto gap = history.at(kStart + 1, kStart + 1 + kSecond / 2);
  ASSERT_TRUE(gap);
  EXPECT_EQ(gap->reason(), Reason::kPoseGap);
  // The same reason when the late pose is already there.
  history.push(odometry(kStart + kSecond), counters);
  EXPECT_EQ(history.at(kStart + 1, kStart)->reason(), Reason::kPoseGap);
}

TEST(PoseHistory, nothingBeforeTheFirstPose) {
  PoseHistory history(0.5);
  Counters counters;
  history.push(odometry(kStart), counters);
  EXPECT_EQ(history.at(kStart - 1, kStart)->reason(), Reason::kNoPoseYet);
  EXPECT_TRUE(*history.at(kStart, kStart));
}

TEST(PoseHistory, countsBadPoses) {
  PoseHistory history(0.5);
  Counters counters;
  history.push(odometry(kStart), counters);
  history.push(odometry(kStart, {1, 0, 0}), counters);
  Odometry bad = odometry(kStart + 1);
  bad.T_map_imu.rotation = Eigen::Quaterniond(0, 0, 0, 0);
  history.push(bad, counters);
  bad.T_map_imu.rotation = Eigen::Quaterniond(std::nan(""), 0, 0, 0);
  history.push(bad, counters);
  EXPECT_EQ(counters.get("skipped odometry: stamp out of order"), 1U);
  EXPECT_EQ(counters.get("skipped odometry: quaternion not normalized"), 1U);
  EXPECT_EQ(counters.get("skipped odometry: not finite"), 1U);
}

}  // namespace
}  // namespace atlas::test
