// SPDX-License-Identifier: MIT
#include "atlas/localization/barometer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stage_run.hpp"

namespace atlas::test {
namespace {

TEST(Barometer, HeightsOfTheStandardAtmosphere) {
  EXPECT_NEAR(pressureHeight(101325.0), 0.0, 1e-9);
  EXPECT_NEAR(pressureHeight(89874.6), 1000.0, 1.0);  // tables of the ICAO standard atmosphere
  EXPECT_NEAR(pressureHeight(79495.2), 2000.0, 1.0);
}

TEST(Barometer, OffsetFollowsWhileThereAreFixesAndHoldsWithout) {
  Counters counters;
  Barometer barometer({true, 1.0, 60.0}, counters);
  const double p0 = 98000.0, p1 = p0 - 120.0;
  for (int i = 0; i <= 300; ++i) EXPECT_FALSE(barometer.add({i * kSecond, p0}, 5.0, true));
  const auto height = barometer.add({302 * kSecond, p1}, 5.0, false);
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->z_map_m, 5.0 + pressureHeight(p1) - pressureHeight(p0), 1e-6);
  EXPECT_NEAR(height->variance_m2, 120.0, 1e-9);  // sigma^2 2 T / dt
  EXPECT_FALSE(barometer.add({302 * kSecond + 1000, p0}, 5.0, false));
}

TEST(Barometer, WhatIsNoPressureIsCounted) {
  Counters counters;
  Barometer barometer({true, 1.0, 60.0}, counters);
  EXPECT_FALSE(barometer.add({kSecond, std::nan("")}, 0.0, false));
  EXPECT_FALSE(barometer.add({2 * kSecond, 980.0}, 0.0, false));  // hPa
  EXPECT_FALSE(barometer.add({3 * kSecond, 98000.0}, std::nullopt, false));
  EXPECT_EQ(counters.get("skipped pressure: not finite"), 1U);
  EXPECT_EQ(counters.get("skipped pressure: not between 300 and 1100 hPa; Pa is needed"), 1U);
  EXPECT_EQ(counters.get("skipped pressure: no pose yet"), 1U);
}

/// The last answer, after 100 s without fixes, of a slow vehicle whose vertical accelerometer is biased.
Odometry afterTheOutage(bool barometer, Counters& counters) {
  DriveParams p;
  p.duration_s = 140.0;
  p.speed = [](double) { return 0.5; };  // too slow for the wheels to hold the height
  const auto truth = drive(p);
  std::mt19937 random(4);
  Errors e = realisticErrors(random);
  e.accelerometer_bias = {0.0, 0.0, 0.04};
  const Recording recording = record(truth, p, e, random);
  LocalizationParams params;
  params.filter = "eskf";
  params.barometer.barometer = barometer;
  params.barometer.barometer_sigma_m = 0.3;
  StageRun run;
  LocalizationStage stage(params);
  listen(stage, run);
  stage.push(truth.front().stamp, rigWith(p.lever_arm_imu));
  for (const GnssFix& fix : recording.fixes) {
    if (fix.stamp < truth.front().stamp + 40 * kSecond) stage.push(fix);
  }
  for (const GnssHeading& heading : recording.headings) stage.push(heading);
  for (const ImuSample& sample : recording.imu) stage.push(sample);
  std::normal_distribution<double> n;
  for (Stamp stamp = truth.front().stamp; barometer && stamp < truth.back().stamp; stamp += kSecond / 50)
    stage.pushPressure({stamp, 98000.0 + 3.0 * n(random)});  // level; 3 Pa are 25 cm
  for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  counters = stage.counters();
  return run.odometry.back();
}

TEST(Barometer, HoldsTheHeightWithoutFixes) {
  Counters without, with;
  const Odometry alone = afterTheOutage(false, without), aided = afterTheOutage(true, with);
  const double drifted = std::abs(alone.T_map_imu.translation.z()),
               held = std::abs(aided.T_map_imu.translation.z());
  EXPECT_LT(held, 0.5 * drifted) << drifted;
  EXPECT_LT(held, 3.0 * std::sqrt(aided.pose_covariance[14]));
  EXPECT_LT(aided.pose_covariance[14], 0.5 * alone.pose_covariance[14]);
  EXPECT_GT(with.get("pressure used"), 80U);
  EXPECT_EQ(with.get("pressure"), 7000U);
  std::uint64_t accounted = with.get("pressure used") + with.get("pressure compared with the fixes");
  for (const auto& [name, count] : with.all()) {
    if (name.rfind("skipped pressure:", 0) == 0) accounted += count;
  }
  EXPECT_EQ(accounted, with.get("pressure"));
}

TEST(Barometer, NeedsTheFilterThatKnowsIt) {
  LocalizationParams params;
  params.filter = "kalman_1d";
  params.barometer.barometer = true;
  EXPECT_THROW(validate(params), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
