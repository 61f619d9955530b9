// SPDX-License-Identifier: MIT
#include "atlas/calibration/rig.hpp"

#include <gtest/gtest.h>

namespace atlas {
namespace {

Pose at(double x, double y, double yaw = 0.0) { return {fromRollPitchYaw({0, 0, yaw}), {x, y, 0}}; }

TEST(Rig, DirectChildOfTheBase) {
  Rig rig;
  EXPECT_TRUE(rig.empty());
  rig.add({{{"base_link", "lidar_left", at(1, 2, 0.3)}}});
  const Outcome<Pose> pose = rig.T_imu("lidar_left");
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->translation, Eigen::Vector3d(1, 2, 0));
  EXPECT_FALSE(rig.empty());
}

TEST(Rig, BaseIsIdentityUnderBothNames) {
  const Rig rig;
  for (const char* name : {"base_link", "imu", "/imu"}) {
    const Outcome<Pose> pose = rig.T_imu(name);
    ASSERT_TRUE(pose) << name;
    EXPECT_EQ(pose->translation, Eigen::Vector3d::Zero());
  }
}

TEST(Rig, ChainIsMultipliedInOrder) {
  Rig rig;  // p_imu = T_imu_mast * T_mast_camera * T_camera_optical * p, added leaf first
  rig.add({{{"camera", "optical", at(0, 1)}}});
  rig.add({{{"mast", "camera", at(2, 0, M_PI / 2)}, {"imu", "mast", at(10, 0, M_PI / 2)}}});
  const Outcome<Pose> pose = rig.T_imu("optical");
  ASSERT_TRUE(pose);
  // mast turns left by 90 deg: its x is imu's y; camera turns once more: its y is imu's -y
  EXPECT_LT((pose->translation - Eigen::Vector3d(10, 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(std::abs(toRollPitchYaw(pose->rotation).yaw), M_PI, 1e-12);
}

TEST(Rig, LeadingSlashIsTheSameFrame) {
  Rig rig;
  rig.add({{{"/base_link", "/lidar", at(1, 0)}}});
  EXPECT_TRUE(rig.T_imu("lidar"));
  EXPECT_TRUE(rig.T_imu("/lidar"));
}

TEST(Rig, UnknownFrameHasNoPose) {
  Rig rig;
  rig.add({{{"base_link", "lidar", at(1, 0)}, {"somewhere", "camera", at(1, 0)}}});
  EXPECT_EQ(rig.T_imu("radar").reason(), Reason::kMissingFrame);
  EXPECT_EQ(rig.T_imu("camera").reason(), Reason::kMissingFrame) << "not connected with the base";
  EXPECT_EQ(rig.T_imu("").reason(), Reason::kMissingFrame);
}

TEST(Rig, LoopEnds) {
  Rig rig;
  rig.add({{{"a", "b", at(1, 0)}, {"b", "c", at(1, 0)}, {"c", "a", at(1, 0)}, {"d", "d", at(1, 0)}}});
  for (const char* name : {"a", "b", "c", "d"})
    EXPECT_EQ(rig.T_imu(name).reason(), Reason::kMissingFrame) << name;
}

TEST(Rig, LaterTransformReplaces) {
  Rig rig;
  rig.add({{{"base_link", "lidar", at(1, 0)}}});
  rig.add({{{"base_link", "lidar", at(5, 0)}}});
  EXPECT_EQ(rig.T_imu("lidar")->translation.x(), 5.0);
  rig.clear();
  EXPECT_FALSE(rig.T_imu("lidar"));
}

}  // namespace
}  // namespace atlas
