// SPDX-License-Identifier: MIT
// The filter itself, without a stage around it: when measurements take effect, and what its odometry says.
#include <gtest/gtest.h>

#include "atlas/localization/kalman_1d_filter.hpp"
#include "simulated_drive.hpp"

namespace atlas::test {
namespace {

constexpr Duration kPeriod = 10 * kMillisecond;
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
Matrix6 matrix(const std::array<double, 36>& covariance) {
  return Eigen::Map<const Matrix6>(covariance.data());
}

/// A filter of a vehicle at rest, level, and what it is fed with.
struct AtRest {
  Counters counters;
  Kalman1dFilter filter;
  ImuSample sample;
  std::optional<Odometry> odometry;

  explicit AtRest(const Eigen::Vector3d& lever_arm_imu = Eigen::Vector3d::Zero(),
                  const PositioningParams& params = {})
      : filter(params, lever_arm_imu, kBrno, counters) {
    sample.linear_acceleration_mps2.z() = normalGravity(kBrno.latitude_deg, kBrno.altitude_m);
    sample.orientation = Eigen::Quaterniond::Identity();
  }
  void imuUntil(Stamp stamp) {
    for (; sample.stamp < stamp; sample.stamp += kPeriod) odometry = filter.propagate(sample);
  }
};

TEST(Kalman1dOdometry, ByHandAfterALongRest) {
  AtRest run;
  run.sample.angular_velocity_radps = {0.01, -0.02,
                                       0.0};  // read, but its roll and pitch are held by the IMU's own
  const Eigen::Matrix3d R = Eigen::Vector3d(4e-4, 1e-4, 16e-4).asDiagonal();
  for (int i = 1; i <= 100; ++i) {
    run.imuUntil(i * 5 * kPeriod);
    run.filter.update(i * 5 * kPeriod - 1, {1.0, 2.0, 3.0}, R);
    run.filter.updateHeading(i * 5 * kPeriod - 1, 0.7, 1e-6);
  }
  run.imuUntil(510 * kPeriod);
  ASSERT_TRUE(run.odometry);
  const Odometry& o = *run.odometry;
  EXPECT_EQ(o.stamp, 509 * kPeriod);
  EXPECT_LT((o.T_map_imu.translation - Eigen::Vector3d(1, 2, 3)).norm(), 0.03);
  EXPECT_NEAR(toRollPitchYaw(o.T_map_imu.rotation).yaw, 0.7, 0.01);
  const Matrix6 P = matrix(o.pose_covariance);
  EXPECT_LT(P(0, 0), R(0, 0)) << "many fixes are better than one";
  EXPECT_LT(P(1, 1), P(0, 0)) << "north is measured better than east";
  EXPECT_LT(P(0, 0), P(2, 2)) << "and up is measured worst";
  EXPECT_EQ(P(0, 1), 0.0) << "three filters that know nothing of each other";
  EXPECT_EQ(P(3, 3), P(4, 4));
}

TEST(Kalman1dOdometry, VelocityCovarianceIsTurnedIntoTheImuFrame) {
  AtRest run;
  // the vehicle looks north; north is measured ten times as well as east
  const Eigen::Matrix3d R = Eigen::Vector3d(0.01, 0.0001, 0.01).asDiagonal();
  for (int i = 1; i <= 60; ++i) {
    run.imuUntil(i * 5 * kPeriod);
    run.filter.update(i * 5 * kPeriod - 1, Eigen::Vector3d::Zero(), R);
    run.filter.updateHeading(i * 5 * kPeriod - 1, M_PI / 2.0, 1e-6);
  }
  run.imuUntil(302 * kPeriod);
  ASSERT_TRUE(run.odometry);
  const Matrix6 V = matrix(run.odometry->twist_covariance);
  EXPECT_LT(V(0, 0), 0.5 * V(1, 1)) << "forward (north) is known better than left (west)";
  EXPECT_NEAR(V(0, 1), 0.0, 0.01 * V(0, 0));
  EXPECT_LT((V - V.transpose()).norm(), 1e-12);
}

TEST(Kalman1dOdometry, AFixTakesEffectWithTheNextSampleAtItsOwnStamp) {
  AtRest run;
  const Eigen::Matrix3d R = 1e-4 * Eigen::Matrix3d::Identity();
  run.imuUntil(10 * kPeriod);
  run.filter.update(9 * kPeriod + kPeriod / 2, Eigen::Vector3d::Zero(), R);
  EXPECT_EQ(run.counters.get("fix used"), 0U) << "no sample has surrounded it yet";
  run.imuUntil(11 * kPeriod);
  EXPECT_EQ(run.counters.get("fix used"), 1U);
  EXPECT_FALSE(run.odometry) << "one fix says nothing about velocity";
}

TEST(Kalman1dOdometry, WhatNoSampleFollowsIsCountedAtTheEnd) {
  AtRest run;
  run.imuUntil(10 * kPeriod);
  run.filter.update(10 * kPeriod, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
  run.filter.updateHeading(11 * kPeriod, 0.0, 1.0);
  run.filter.finish();
  EXPECT_EQ(run.counters.get("skipped fix: after the last imu sample"), 1U);
  EXPECT_EQ(run.counters.get("skipped heading: after the last imu sample"), 1U);
}

// Constant memory: an IMU that never comes, or stops, must not make the filter keep every fix of the drive.
TEST(Kalman1dOdometry, FixesDoNotPileUpWithoutImu) {
  for (const bool some_imu : {false, true}) {
    AtRest run;
    if (some_imu) run.imuUntil(10 * kPeriod);
    for (int i = 0; i < 1000; ++i)
      run.filter.update(kSecond + i * kSecond / 20, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
    EXPECT_EQ(run.counters.get("skipped fix: no imu samples around it"), 999U)
        << "only the newest can still be used";
  }
}

TEST(Kalman1dOdometry, AShortPauseOfTheImuLosesNoFix) {
  AtRest run;
  run.imuUntil(10 * kPeriod);
  for (int i = 1; i <= 8; ++i)
    run.filter.update(9 * kPeriod + i * 5 * kPeriod, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
  run.sample.stamp = 9 * kPeriod + 45 * kPeriod;  // 0.45 s: shorter than max_imu_gap_s
  run.filter.propagate(run.sample);
  EXPECT_EQ(run.counters.get("fix used"), 8U);
}

}  // namespace
}  // namespace atlas::test
