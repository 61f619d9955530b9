// SPDX-License-Identifier: MIT
#include "atlas/localization/eskf_start.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace atlas::eskf {
namespace {

const Geodetic kAnchor{49.2, 16.6, 280.0};
const Eigen::Matrix3d kFixNoise = 4e-4 * Eigen::Matrix3d::Identity();

Inertial restAt(double roll, double pitch) {
  return {Eigen::Vector3d::Zero(),
          fromRollPitchYaw({roll, pitch, 0.0}).conjugate() * Eigen::Vector3d(0.0, 0.0, 9.81)};
}

TEST(EskfStart, NothingIsGuessed) {
  const Earth earth(kAnchor);
  Start start({}, Eigen::Vector3d::Zero(), earth);
  const Inertial rest = restAt(0.0, 0.0);
  for (int i = 0; i < 300; ++i) {
    start.move(rest, rest, 0.01);
    if (i % 10 == 0) start.fix({0.0, 0.0, 0.0}, kFixNoise);
  }
  EXPECT_FALSE(start.result(rest));  // standing without a receiver's heading: no heading
  start.heading(0.7, 0.003);
  ASSERT_TRUE(start.result(rest));
}

TEST(EskfStart, StandingTakesRollAndPitchFromGravity) {
  const Earth earth(kAnchor);
  const Eigen::Vector3d lever(-0.5, 0.2, 0.1);
  Start start({}, lever, earth);
  const Inertial rest = restAt(0.05, -0.08);
  for (int i = 0; i < 300; ++i) {
    start.move(rest, rest, 0.01);
    if (i % 10 == 0) start.fix({1.0, 2.0, 3.0}, kFixNoise);
  }
  start.heading(0.7, 0.003);
  const auto result = start.result(rest);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->from_velocity);
  const RollPitchYaw rpy = toRollPitchYaw(result->state.R);
  EXPECT_NEAR(rpy.roll, 0.05, 1e-6);
  EXPECT_NEAR(rpy.pitch, -0.08, 1e-6);
  EXPECT_NEAR(rpy.yaw, 0.7, 1e-9);
  EXPECT_LT((result->state.p + result->state.R * lever - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-6);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(result->P);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-12);  // a covariance
}

TEST(EskfStart, InMotionTakesTheHeadingOfTheVelocity) {
  const Earth earth(kAnchor);
  Start start({}, Eigen::Vector3d::Zero(), earth);
  const Inertial rest = restAt(0.0, 0.0);
  for (int i = 0; i < 300; ++i) {
    start.move(rest, rest, 0.01);
    if (i % 10 == 9) start.fix({-0.05 * i, 0.05 * i, 0.0}, kFixNoise);  // north-west at 7 m/s
  }
  const auto result = start.result(rest);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->from_velocity);
  EXPECT_NEAR(toRollPitchYaw(result->state.R).yaw, 0.75 * M_PI, 0.02);
  EXPECT_GT(result->P(kTheta + 2, kTheta + 2), 0.03 * 0.03);  // the imu may be mounted turned
}

}  // namespace
}  // namespace atlas::eskf
