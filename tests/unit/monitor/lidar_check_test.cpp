// SPDX-License-Identifier: MIT
#include "atlas/monitor/lidar_check.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "atlas/monitor/lidar_pair_check.hpp"
#include "atlas/monitor/radar_check.hpp"
#include "atlas/monitor/scan_summary.hpp"
#include "watched.hpp"

namespace atlas {
namespace {

using test::at;
using test::expectClean;
using test::expectSeen;

/// A lidar of 32 beams, 2 m above the road of a street with walls 8 m to both sides; 2 cm of noise.
struct Scanner {
  LidarCheck check{{}};
  Findings findings{AnomalyThresholds()};
  std::mt19937 random{1};
  double time_s = 0.0;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< of this lidar in the street
  double scale = 1.0, keep = 1.0;                   ///< of ranges; share of returns
  int dead_beam = -1;
  double blocked_from_deg = 0, blocked_to_deg = 0;

  Sweep scan() {
    std::normal_distribution<double> noise(0.0, 0.02);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    Sweep sweep;
    sweep.stamp = at(time_s);
    constexpr int kColumns = 900;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2.0 * M_PI * column / kColumns - M_PI;
      const bool blocked = azimuth * 180 / M_PI >= blocked_from_deg && azimuth * 180 / M_PI < blocked_to_deg;
      for (std::uint16_t ring = 0; ring < 32; ++ring) {
        LidarPoint p;
        p.ring = ring;
        const double elevation = (-30.67 + 1.333 * ring) * M_PI / 180.0;
        const double to_wall = (8.0 - (std::sin(azimuth) > 0 ? place.y() : -place.y())) /
                               std::max(1e-6, std::abs(std::sin(azimuth)));
        double range = std::min(80.0, to_wall / std::cos(elevation));
        if (elevation < 0) range = std::min(range, 2.0 / std::sin(-elevation));
        range = scale * range + noise(random);
        const bool lost = blocked || ring == dead_beam || range >= 80.0 || chance(random) > 0.99 * keep;
        const float nan = std::numeric_limits<float>::quiet_NaN();
        p.x = lost ? nan : static_cast<float>(range * std::cos(elevation) * std::cos(azimuth));
        p.y = lost ? nan : static_cast<float>(range * std::cos(elevation) * std::sin(azimuth));
        p.z = lost ? nan : static_cast<float>(range * std::sin(elevation));
        sweep.points.push_back(p);
      }
    }
    return sweep;
  }
  RangeProfile run(double until_s) {
    RangeProfile profile;
    for (; time_s < until_s - 1e-6; time_s += 0.1) {
      profile = RangeProfile();
      const Sweep sweep = scan();
      check.add(sweep.stamp,
                summaryOf(sweep,
                          [&](const LidarPoint& p) {
                            profile.add({p.x, p.y, p.z});
                          }),
                findings);
    }
    return profile;
  }
};

TEST(LidarCheck, OrdinaryScansAreNoAnomaly) {
  Scanner lidar;
  lidar.run(6);
  expectClean(lidar.findings);
}

TEST(LidarCheck, EmptyAndFrozenScansAreSeenAtOnce) {
  Scanner lidar;
  lidar.run(2);
  lidar.keep = 0.0;
  lidar.run(2.1);
  expectSeen(lidar.findings, Anomaly::kScanEmpty, 2.0, 0.0);
  lidar.keep = 1.0;
  const Sweep same = lidar.scan();
  for (int i = 1; i <= 3; ++i)
    lidar.check.add(at(2.1 + 0.1 * i), summaryOf(same, [](const LidarPoint&) {}), lidar.findings);
  expectSeen(lidar.findings, Anomaly::kScanFrozen, 2.2, 0.2);
}

TEST(LidarCheck, AThirdOfThePointsIsSeenAtOnceAndDoesNotBecomeUsual) {
  Scanner lidar;
  lidar.run(3);
  lidar.keep = 0.33;
  lidar.run(9);
  expectSeen(lidar.findings, Anomaly::kFewPoints, 3.0, 0.01);
}

TEST(LidarCheck, ADeadBeamIsSeenWithinTwoSecondsUnlessItIsKnown) {
  Scanner lidar;
  lidar.run(2);
  lidar.dead_beam = 14;
  lidar.run(6);
  expectSeen(lidar.findings, Anomaly::kDeadBeams, 2.0, 2.3);
  Scanner known;
  known.check = LidarCheck({14});
  known.dead_beam = 14;
  known.run(4);
  expectClean(known.findings);
}

TEST(LidarCheck, ABlockedSectorIsSeenAtTheThirdScan) {
  Scanner lidar;
  lidar.run(3);
  lidar.blocked_from_deg = 30;
  lidar.blocked_to_deg = 70;
  lidar.run(9);
  expectSeen(lidar.findings, Anomaly::kBlocked, 3.0, 0.31);
  EXPECT_NEAR(lidar.findings.list().front().value, 40.0, 10.1);
}

TEST(LidarCheck, WhatTheVehicleAlwaysCoversIsNoBlockage) {
  Scanner lidar;
  lidar.blocked_from_deg = 150;
  lidar.blocked_to_deg = 180;
  lidar.run(4);
  expectClean(lidar.findings);
}

struct Pair {
  Scanner left, right;
  LidarPairCheck check;
  Findings of_left{AnomalyThresholds()}, of_right{AnomalyThresholds()};
  /// Both lidars with the base 1 m apart from both walls' middle: base_link between them.
  void run(double until_s) {
    const Eigen::Vector3f left_at(0, 0.5F, 0), right_at(0, -0.5F, 0);
    for (; left.time_s < until_s - 1e-6;) {
      check.add(0, at(left.time_s), profileOf(left, left_at), of_left, of_right);
      check.add(1, at(left.time_s + 0.03), profileOf(right, right_at), of_left, of_right);
      left.time_s += 0.1;
      right.time_s += 0.1;
    }
  }
  static RangeProfile profileOf(Scanner& lidar, const Eigen::Vector3f& t_imu_lidar) {
    lidar.place.y() = t_imu_lidar.y();
    RangeProfile profile;
    summaryOf(lidar.scan(),
              [&](const LidarPoint& p) { profile.add(Eigen::Vector3f(p.x, p.y, p.z) + t_imu_lidar); });
    return profile;
  }
};

TEST(LidarPairCheck, RangesOfBothAgree) {
  Pair pair;
  pair.run(4);
  expectClean(pair.of_left);
  expectClean(pair.of_right);
}

TEST(LidarPairCheck, TenPercentOfRangeIsSeenWithinThreeSeconds) {
  Pair pair;
  pair.run(2);
  pair.right.scale = 1.1;
  pair.run(6);
  expectSeen(pair.of_left, Anomaly::kRangeOffset, 2.0, 3.0);
  expectSeen(pair.of_right, Anomaly::kRangeOffset, 2.0, 3.0);
}

TEST(RadarCheck, FrozenTargetsAreSeenButNotAnEmptyView) {
  RadarCheck check;
  Findings findings{AnomalyThresholds()};
  RadarScan scan;
  for (int i = 0; i < 40; ++i) {
    scan.stamp = at(0.05 * i);
    check.add(scan, findings);
  }
  expectClean(findings);
  scan.targets.push_back({{10, 1, 0}, -3.0});
  for (int i = 40; i < 60; ++i) {
    scan.stamp = at(0.05 * i);
    check.add(scan, findings);
  }
  expectSeen(findings, Anomaly::kTargetsFrozen, 2.0, 0.6);
  scan.stamp = at(3.0);
  scan.targets[0].radial_velocity_mps = std::nan("");
  check.add(scan, findings);
  expectSeen(findings, Anomaly::kNotFinite, 3.0, 0.0);
}

}  // namespace
}  // namespace atlas
