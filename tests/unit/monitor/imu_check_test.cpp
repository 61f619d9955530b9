// SPDX-License-Identifier: MIT
#include "atlas/monitor/imu_check.hpp"

#include <random>

#include "atlas/monitor/magnetic_check.hpp"
#include "atlas/monitor/pressure_check.hpp"
#include "watched.hpp"

namespace atlas {
namespace {

using test::at;
using test::expectClean;
using test::expectSeen;

/// 200 Hz, noise of a MEMS sensor with the vibration of a driving car.
struct Inertial {
  explicit Inertial(const AnomalyThresholds& thresholds = {}) : check(thresholds) {}
  ImuCheck check;
  Findings findings{AnomalyThresholds()};
  std::mt19937 random{1};
  double time_s = 0.0;
  bool standing = false;
  Eigen::Vector3d gyro_bias_radps{0.002, -0.001, 0.001};

  ImuSample next(const Eigen::Vector3d& force_mps2, double yaw_rate_radps) {
    std::normal_distribution<double> force(0.0, standing ? 0.05 : 0.3), rate(0.0, standing ? 0.003 : 0.01);
    ImuSample sample;
    sample.stamp = at(time_s);
    sample.linear_acceleration_mps2 =
        force_mps2 + Eigen::Vector3d(force(random), force(random), force(random));
    sample.angular_velocity_radps =
        gyro_bias_radps + Eigen::Vector3d(rate(random), rate(random), yaw_rate_radps + rate(random));
    time_s += 0.005;
    return sample;
  }
  void run(double until_s, const Eigen::Vector3d& force_mps2 = {0, 0, 9.81}, double yaw_rate_radps = 0.0) {
    while (time_s < until_s) check.add(next(force_mps2, yaw_rate_radps), standing, findings);
  }
};

TEST(ImuCheck, DrivingBrakingTurningAndStandingAreNoAnomalies) {
  Inertial imu;
  imu.run(10);
  imu.run(13, {-4.0, 0, 9.81});      // hard braking: norm 10.6
  imu.run(18, {0, 3.5, 9.81}, 0.4);  // a fast bend
  imu.standing = true;
  imu.run(30);
  expectClean(imu.findings);
}

TEST(ImuCheck, FrozenIsSeenAfterItsTime) {
  Inertial imu;
  imu.run(5);
  ImuSample frozen = imu.next({0, 0, 9.81}, 0);
  for (; imu.time_s < 6; imu.time_s += 0.005) {
    frozen.stamp = at(imu.time_s);
    imu.check.add(frozen, false, imu.findings);
  }
  expectSeen(imu.findings, Anomaly::kImuFrozen, 5.0, 0.25);
}

TEST(ImuCheck, SaturationAtAGivenRangeIsSeenAtOnce) {
  AnomalyThresholds thresholds;
  thresholds[Anomaly::kAccelerometerSaturated] = 50.0;
  Inertial imu(thresholds);
  imu.run(5);
  ImuSample clipped = imu.next({0, 0, 9.81}, 0);
  clipped.linear_acceleration_mps2.z() = 50.0;
  imu.check.add(clipped, false, imu.findings);
  expectSeen(imu.findings, Anomaly::kAccelerometerSaturated, 5.0, 0.006);
  EXPECT_FALSE(imu.findings.has(Anomaly::kGyroscopeSaturated));
}

TEST(ImuCheck, ScaleOfTheAccelerometerIsSeenByGravityWithinFourSeconds) {
  Inertial imu;
  imu.run(10);
  imu.run(15, {0, 0, 9.81 * 1.15});
  expectSeen(imu.findings, Anomaly::kGravity, 10.0, 4.0);
}

TEST(ImuCheck, GravityInGIsWrongUnits) {
  Inertial imu;
  std::normal_distribution<double> noise(0.0, 0.01);
  for (; imu.time_s < 4; imu.time_s += 0.005) {
    ImuSample sample;
    sample.stamp = at(imu.time_s);
    sample.linear_acceleration_mps2 = {noise(imu.random), noise(imu.random), 1.0 + noise(imu.random)};
    sample.angular_velocity_radps = {noise(imu.random), 0, 0};
    imu.check.add(sample, false, imu.findings);
  }
  expectSeen(imu.findings, Anomaly::kImuUnits, 0.0, 2.1);
  EXPECT_DOUBLE_EQ(imu.findings.score(), 0.0);
}

TEST(ImuCheck, BiasJumpIsSeenInTheSecondSecondOfAStandstill) {
  Inertial imu;
  imu.standing = true;
  imu.run(10);
  imu.standing = false;
  imu.run(20, {0, 0, 9.81}, 0.2);
  imu.gyro_bias_radps.z() += 0.02;  // 1.1 deg/s
  imu.run(25, {0, 0, 9.81}, 0.2);
  EXPECT_FALSE(imu.findings.has(Anomaly::kGyroBias)) << "not to be seen while it drives";
  imu.standing = true;
  imu.run(30);
  expectSeen(imu.findings, Anomaly::kGyroBias, 25.0, 2.2);
}

TEST(ImuCheck, NotANumberIsNotGivenToTheOtherChecks) {
  Inertial imu;
  imu.run(5);
  ImuSample bad = imu.next({0, 0, 9.81}, 0);
  bad.linear_acceleration_mps2.x() = std::nan("");
  imu.check.add(bad, false, imu.findings);
  expectSeen(imu.findings, Anomaly::kNotFinite, 5.0, 0.006);
  imu.run(12);
  EXPECT_TRUE(imu.findings.list().empty()) << "it is over, and nothing stays behind";
}

TEST(MagneticCheck, SteelNearbyChangesTheNorm) {
  MagneticCheck check;
  Findings findings{AnomalyThresholds()};
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.005);
  for (double t = 0; t < 40; t += 0.01) {
    const double turn = 0.1 * t, size = t < 30 ? 1.0 : 1.5;  // the vehicle turns: the norm stays
    check.add({at(t), size * Eigen::Vector3d(std::cos(turn) + noise(random), std::sin(turn), -1.0)},
              findings);
    if (t < 30) {
      ASSERT_TRUE(findings.list().empty()) << t;
    }
  }
  expectSeen(findings, Anomaly::kMagneticNorm, 30.0, 2.1);
}

TEST(MagneticCheck, FrozenIsSeenAfterHalfASecond) {
  MagneticCheck check;
  Findings findings{AnomalyThresholds()};
  for (double t = 0; t < 3; t += 0.01)
    check.add({at(t), {1.0 + (t < 2 ? 1e-3 * std::sin(50 * t) : 0.0), 0, 1}}, findings);
  expectSeen(findings, Anomaly::kMagneticFrozen, 2.0, 0.55);
}

TEST(PressureCheck, FrozenAndSteps) {
  PressureCheck check;
  Findings findings{AnomalyThresholds()};
  for (double t = 0; t < 20; t += 0.02)
    check.add({at(t), 98880.0 + (t < 10 ? std::round(3 * std::sin(7 * t)) : 0.0)}, findings);
  expectSeen(findings, Anomaly::kPressureFrozen, 9.9, 5.2);
  check.add({at(20), 99300.0}, findings);
  expectSeen(findings, Anomaly::kPressureStep, 20.0, 0.0);
}

}  // namespace
}  // namespace atlas
