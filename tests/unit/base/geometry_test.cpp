// SPDX-License-Identifier: MIT
#include "atlas/base/geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace atlas {
namespace {

Eigen::Vector3d randomVector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  const double x = u(random), y = u(random), z = u(random);
  return {x, y, z};
}
Pose randomPose(std::mt19937& random) {
  return {expSo3(randomVector(random, 3.0)), randomVector(random, 50.0)};
}

TEST(Pose, WorkedExample) {
  // imu at (1, 2, 0) looking west of north-east by 90 deg: its x axis is map's y axis.
  const Pose T_map_imu{fromRollPitchYaw({0, 0, M_PI / 2}), {1, 2, 0}};
  EXPECT_LT((T_map_imu * Eigen::Vector3d(3, 0, 0) - Eigen::Vector3d(1, 5, 0)).norm(), 1e-12);
  const Pose T_imu_lidar{Eigen::Quaterniond::Identity(), {0, 1, 0.5}};
  EXPECT_LT(((T_map_imu * T_imu_lidar).translation - Eigen::Vector3d(0, 2, 0.5)).norm(), 1e-12);
}

TEST(Pose, GroupLaws) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose a = randomPose(random), b = randomPose(random), c = randomPose(random);
    const Eigen::Vector3d p = randomVector(random, 20.0);
    EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-11);
    EXPECT_LT((((a * b) * c) * p - (a * (b * c)) * p).norm(), 1e-11);
    EXPECT_LT((a.inverse() * (a * p) - p).norm(), 1e-11);
    EXPECT_LT(((a * b).inverse() * p - (b.inverse() * a.inverse()) * p).norm(), 1e-11);
  }
}

TEST(Pose, MatrixIsTheSameMap) {
  std::mt19937 random(2);
  const Pose a = randomPose(random);
  const Eigen::Vector3d p(1, -2, 3);
  EXPECT_LT((a.matrix34f() * p.cast<float>().homogeneous() - (a * p).cast<float>()).norm(), 1e-4F);
}

TEST(Interpolate, EndsMiddleAndBounds) {
  const Pose a{Eigen::Quaterniond::Identity(), {0, 0, 0}}, b{fromRollPitchYaw({0, 0, 1.0}), {4, 2, 0}};
  EXPECT_EQ(interpolate(a, b, 0.0).translation, a.translation);
  EXPECT_EQ(interpolate(a, b, 1.0).translation, b.translation);
  EXPECT_NEAR(toRollPitchYaw(interpolate(a, b, 0.25).rotation).yaw, 0.25, 1e-12);
  EXPECT_LT((interpolate(a, b, 0.25).translation - Eigen::Vector3d(1, 0.5, 0)).norm(), 1e-12);
  for (const double outside : {-1e-9, 1.0 + 1e-9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(interpolate(a, b, outside), std::invalid_argument);
  }
}

TEST(Interpolate, TakesTheShortWayRoundTheCircle) {
  const Pose a{fromRollPitchYaw({0, 0, M_PI - 0.1}), {}}, b{fromRollPitchYaw({0, 0, -M_PI + 0.1}), {}};
  EXPECT_NEAR(std::abs(toRollPitchYaw(interpolate(a, b, 0.5).rotation).yaw), M_PI, 1e-9);
}

TEST(RollPitchYaw, RoundTripAndAxes) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d v = randomVector(random, 1.5);
    const RollPitchYaw rpy = toRollPitchYaw(fromRollPitchYaw({2 * v.x(), v.y(), 2 * v.z()}));
    EXPECT_NEAR(wrapAngle(rpy.roll - 2 * v.x()), 0.0, 1e-9);
    EXPECT_NEAR(rpy.pitch, v.y(), 1e-9);
    EXPECT_NEAR(wrapAngle(rpy.yaw - 2 * v.z()), 0.0, 1e-9);
  }
  // positive yaw: from x to y (left); positive pitch: nose down; positive roll: left side up (REP-103)
  EXPECT_NEAR((fromRollPitchYaw({0, 0, 0.1}) * Eigen::Vector3d::UnitX()).y(), std::sin(0.1), 1e-12);
  EXPECT_NEAR((fromRollPitchYaw({0, 0.1, 0}) * Eigen::Vector3d::UnitX()).z(), -std::sin(0.1), 1e-12);
  EXPECT_NEAR((fromRollPitchYaw({0.1, 0, 0}) * Eigen::Vector3d::UnitY()).z(), std::sin(0.1), 1e-12);
}

TEST(RollPitchYaw, GimbalLockIsFinite) {
  const RollPitchYaw rpy = toRollPitchYaw(fromRollPitchYaw({0.3, M_PI / 2, 0.2}));
  EXPECT_NEAR(rpy.pitch, M_PI / 2, 1e-6);
  EXPECT_TRUE(std::isfinite(rpy.roll) && std::isfinite(rpy.yaw));
}

TEST(WrapAngle, HalfOpenInterval) {
  EXPECT_EQ(wrapAngle(0.0), 0.0);
  EXPECT_EQ(wrapAngle(M_PI), M_PI);
  EXPECT_EQ(wrapAngle(-M_PI), M_PI);
  EXPECT_NEAR(wrapAngle(3 * M_PI + 0.1), -M_PI + 0.1, 1e-12);
  EXPECT_NEAR(wrapAngle(-7.0), -7.0 + 2 * M_PI, 1e-12);
}

TEST(So3, ExpOfLogAndLogOfExp) {
  std::mt19937 random(4);
  for (const double size : {1e-12, 1e-8, 1e-6, 1e-3, 0.5, 1.7}) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d v = randomVector(random, size);
      EXPECT_LT((logSo3(expSo3(v)) - v).norm(), 1e-9 * std::max(1.0, v.norm())) << size;
      EXPECT_NEAR(expSo3(v).norm(), 1.0, 1e-12);
    }
  }
  EXPECT_EQ(logSo3(Eigen::Quaterniond::Identity()), Eigen::Vector3d::Zero());
}

TEST(So3, QuaternionAndItsNegativeAreOneRotation) {
  Eigen::Quaterniond q = expSo3({0.3, -0.2, 0.9});
  const Eigen::Vector3d v = logSo3(q);
  q.coeffs() *= -1.0;
  EXPECT_LT((logSo3(q) - v).norm(), 1e-12);
}

TEST(So3, HalfTurn) { EXPECT_NEAR(logSo3(expSo3({M_PI, 0, 0})).norm(), M_PI, 1e-9); }

TEST(Skew, IsTheCrossProduct) {
  const Eigen::Vector3d a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-12);
  EXPECT_LT((skew(a) + skew(a).transpose()).norm(), 1e-15);
}

}  // namespace
}  // namespace atlas
