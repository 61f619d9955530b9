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

Stamp stampOf(int sample) { return kSecond + sample * (kSecond / 100); }

TEST(EskfStart, NothingIsGuessed) {
  const Earth earth(kAnchor);
  Start start({}, Eigen::Vector3d::Zero(), earth);
  const Inertial rest = restAt(0.0, 0.0);
  for (int i = 0; i < 300; ++i) {
    start.move(stampOf(i), rest, rest, 0.01);
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
    start.move(stampOf(i), rest, rest, 0.01);
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
    start.move(stampOf(i), rest, rest, 0.01);
    if (i % 10 == 9) start.fix({-0.05 * i, 0.05 * i, 0.0}, kFixNoise);  // north-west at 7 m/s
  }
  const auto result = start.result(rest);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->from_velocity);
  EXPECT_NEAR(toRollPitchYaw(result->state.R).yaw, 0.75 * M_PI, 0.02);
  EXPECT_GT(result->P(kTheta + 2, kTheta + 2), 0.03 * 0.03);  // the imu may be mounted turned
}

TEST(EskfStart, StandingMeasuresTheGyroscopesBias) {
  const Earth earth(kAnchor);
  Start start({}, Eigen::Vector3d::Zero(), earth);
  const Eigen::Vector3d bias(0.012, -0.017, 0.009);  // about 1 deg/s
  Inertial imu = restAt(0.05, -0.08);
  imu.rate_radps = bias;
  // 20 s of standing, then 3 s in which the car drives off eastwards with 2 m/s^2.
  for (int i = 0; i < 2300; ++i) {
    const double driven_s = std::max(0.0, 0.01 * (i - 2000));
    if (driven_s > 0.0)
      imu.force_mps2 = fromRollPitchYaw({0.05, -0.08, 0.0}).conjugate() * Eigen::Vector3d(2.0, 0.0, 9.81);
    start.move(stampOf(i), imu, imu, 0.01);
    if (i % 10 == 0) start.fix({driven_s * driven_s, 0.0, 0.0}, kFixNoise);
  }
  const auto result = start.result(imu);
  ASSERT_TRUE(result);
  EXPECT_LT((result->state.gyro_bias - bias).norm(), 2e-4);
  EXPECT_LT(result->P(kGyro, kGyro), 1e-3 * 1e-3);
  const RollPitchYaw rpy = toRollPitchYaw(result->state.R);
  // The block of 0.2 s in which it drives off still counts: 0.2 s of 10 s of a tilt of 0.2.
  EXPECT_NEAR(rpy.roll, 0.05, 0.005);  // the mean of the force over 10 s would err by 0.06 and more
  EXPECT_NEAR(rpy.pitch, -0.08, 0.005);
}

TEST(EskfStart, SpeedingUpIsNotTilt) {
  const Earth earth(kAnchor);
  Start start({}, Eigen::Vector3d::Zero(), earth);
  const Inertial imu{Eigen::Vector3d::Zero(), fromRollPitchYaw({0.03, 0.06, 0.0}).conjugate() *
                                                  Eigen::Vector3d(2.0, 0.0, earth.gravity_mps2)};
  for (int i = 0; i < 400; ++i) {
    const double t = 0.01 * (i + 1);
    start.move(stampOf(i), imu, imu, 0.01);
    if (i % 10 == 9) start.fix({0.0, 8.0 * t + t * t, 0.0}, kFixNoise);  // northwards
  }
  const auto result = start.result(imu);
  ASSERT_TRUE(result);
  const RollPitchYaw rpy = toRollPitchYaw(result->state.R);
  const double sigma = std::sqrt(result->P(kTheta, kTheta));
  EXPECT_LT(sigma, 0.1);  // less than the tilt of 0.2 that the mean force shows
  EXPECT_NEAR(rpy.roll, 0.03, 0.02);
  EXPECT_NEAR(rpy.pitch, 0.06, 0.02);
}

TEST(EskfStart, TheAccelerometersBiasAndTheTiltItMakesAreOne) {
  const Earth earth(kAnchor);
  Start start({}, Eigen::Vector3d::Zero(), earth);
  const Eigen::Vector3d bias(0.3, 0.0, 0.0);
  Inertial imu = restAt(0.0, 0.0);
  imu.force_mps2 += bias;
  for (int i = 0; i < 300; ++i) {
    start.move(stampOf(i), imu, imu, 0.01);
    if (i % 10 == 0) start.fix(Eigen::Vector3d::Zero(), kFixNoise);
  }
  start.heading(0.0, 0.003);
  const auto result = start.result(imu);
  ASSERT_TRUE(result);
  // Told the bias exactly, the filter must level itself: theta = cov(theta, b) cov(b)^-1 b.
  const Matrix& P = result->P;
  const Eigen::Vector3d theta =
      P.block<3, 3>(kTheta, kAccel) * P.block<3, 3>(kAccel, kAccel).inverse() * bias;
  const Eigen::Quaterniond level = expSo3(theta) * result->state.R;
  EXPECT_LT((level * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(), 2e-3);
  EXPECT_GT((result->state.R * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(), 0.02);
}

}  // namespace
}  // namespace atlas::eskf
