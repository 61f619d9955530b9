// SPDX-License-Identifier: MIT
#include "atlas/monitor/gnss_check.hpp"

#include <cmath>
#include <random>

#include "atlas/monitor/motion_witness.hpp"
#include "watched.hpp"

namespace atlas {
namespace {

using test::at;
using test::expectClean;
using test::expectSeen;

/// A receiver at 20 Hz on a car that accelerates, turns at 12 m/s and brakes.
struct Receiver {
  GnssCheck check;
  Findings findings{AnomalyThresholds()};
  LocalEnu map{{49.2281, 16.5755, 281.0}};
  std::mt19937 random{1};
  double noise_m = 0.02, time_s = 0.0, yaw_rad = 0.0, speed_mps = 0.0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero(), offset = Eigen::Vector3d::Zero();
  std::optional<double> sigma_m;
  bool with_heading = true;

  void run(double until_s, double acceleration_mps2 = 0.0, double turn_radps = 0.0) {
    std::normal_distribution<double> noise(0.0, 1.0);
    for (; time_s < until_s; time_s += 0.05) {
      speed_mps = std::max(0.0, speed_mps + 0.05 * acceleration_mps2);
      yaw_rad = std::remainder(yaw_rad + 0.05 * turn_radps, 2.0 * M_PI);
      place += 0.05 * speed_mps * Eigen::Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
      GnssFix fix;
      fix.stamp = at(time_s);
      const Eigen::Vector3d error(noise(random), noise(random), noise(random));
      fix.position = map.toGeodetic(place + offset + noise_m * error);
      if (sigma_m) fix.covariance_enu_m2 = {*sigma_m * *sigma_m, 0, 0, 0, *sigma_m * *sigma_m, 0, 0, 0, 1};
      check.add(fix, findings);
      if (with_heading)
        check.add(GnssHeading{fix.stamp, yaw_rad + 0.025 * noise(random), std::nullopt}, findings);
    }
  }
};

TEST(GnssCheck, DrivingIsNoAnomaly) {
  Receiver r;
  r.run(5);
  r.run(10, 2.5);
  r.run(20, 0.0, 0.6);
  r.run(22, -6.0);
  r.run(30);
  expectClean(r.findings);
}

TEST(GnssCheck, AReceiverOfThreeMetresThatSaysSoDoesNotJump) {
  Receiver r;
  r.noise_m = r.sigma_m.emplace(1.5);
  r.run(5);
  r.run(10, 2.5);
  r.run(30);
  expectClean(r.findings);
}

TEST(GnssCheck, AJumpOfFourMetresIsSeenAtItsFirstFix) {
  Receiver r;
  r.run(5, 2.0);
  r.run(10);
  r.offset.x() = 4.0;
  r.run(10.5);
  expectSeen(r.findings, Anomaly::kPositionJump, 10.0, 0.06);
  EXPECT_LT(r.findings.score(), 0.3);
  r.run(13);
  EXPECT_FALSE(r.findings.has(Anomaly::kPositionJump)) << "it goes on from there";
}

TEST(GnssCheck, AStreamFasterThanItsReceiverDoesNotJump) {
  GnssCheck check;
  Findings findings{AnomalyThresholds()};
  const LocalEnu map({49.2281, 16.5755, 281.0});
  for (int i = 0; i < 1500; ++i) {  // 50 Hz, a new position at 4 Hz, at 14 m/s
    const double t = 0.02 * i, measured = 0.24 * std::floor(t / 0.24);
    GnssFix fix;
    fix.stamp = at(t);
    fix.position = map.toGeodetic({14.0 * measured, 0, 0});
    check.add(fix, findings);
  }
  expectClean(findings);
}

TEST(GnssCheck, LargeCovarianceZeroPositionAndFrozen) {
  Receiver r;
  r.sigma_m = 0.02;
  r.run(5);
  r.sigma_m = 8.0;
  r.run(6);
  expectSeen(r.findings, Anomaly::kPositionSigma, 5.0, 0.06);
  GnssFix none;
  none.stamp = at(6);
  r.check.add(none, r.findings);
  expectSeen(r.findings, Anomaly::kNoPosition, 6.0, 0.0);
  EXPECT_DOUBLE_EQ(r.findings.score(), 0.0);
  r.time_s = 6.05;
  r.noise_m = 0.0;
  r.run(11);
  expectSeen(r.findings, Anomaly::kFixFrozen, 6.0, 3.2);
}

TEST(GnssCheck, LostHeadingIsSeenAfterASecond) {
  Receiver r;
  r.run(5);
  r.with_heading = false;
  r.run(7);
  expectSeen(r.findings, Anomaly::kHeadingLost, 5.0, 1.1);
  Receiver without;
  without.with_heading = false;
  without.run(10);
  EXPECT_FALSE(without.findings.has(Anomaly::kHeadingLost)) << "it never had one";
}

TEST(GnssCheck, HeadingJumpIsSeenAtOnce) {
  Receiver r;
  r.run(5);
  r.yaw_rad = 1.0;
  r.run(5.1);
  expectSeen(r.findings, Anomaly::kHeadingJump, 5.0, 0.06);
}

TEST(MotionWitness, KnowsStandingMovingAndWhenItDoesNotKnow) {
  Receiver r;
  r.run(3);
  EXPECT_TRUE(r.check.motion().standing(at(3)));
  EXPECT_FALSE(r.check.motion().moving(at(3)));
  EXPECT_FALSE(r.check.motion().standing(at(10))) << "old news";
  r.run(5, 2.0);
  EXPECT_TRUE(r.check.motion().moving(at(5)));
  EXPECT_FALSE(r.check.motion().standing(at(5)));
  r.noise_m = 0.0;
  r.speed_mps = 0.0;
  r.run(8);
  EXPECT_FALSE(r.check.motion().standing(at(8))) << "a frozen position is no proof";
}

}  // namespace
}  // namespace atlas
