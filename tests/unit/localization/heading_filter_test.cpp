// SPDX-License-Identifier: MIT
#include "atlas/localization/heading_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "atlas/base/geometry.hpp"

namespace atlas {
namespace {

constexpr double kDeg = M_PI / 180.0;
constexpr double kGnssVariance = 9.0 * kDeg * kDeg;

VelocityHeading moving(double course_rad, double speed_mps, double yaw_rate_radps = 0.0) {
  return {course_rad, std::pow(0.03 / speed_mps, 2), speed_mps, yaw_rate_radps};
}

TEST(HeadingFilter, FirstGnssHeadingHasItsWholeVariance) {
  HeadingFilter filter({});
  EXPECT_FALSE(filter.known());
  filter.initializeFromGnss(kGnssVariance);
  EXPECT_TRUE(filter.known());
  EXPECT_DOUBLE_EQ(filter.yawVariance(), kGnssVariance);
}

TEST(HeadingFilter, CorrelatedGnssNoiseIsNotAveragedAwayInASecond) {
  HeadingFilter filter({});
  filter.initializeFromGnss(kGnssVariance);
  for (int i = 0; i < 20; ++i) {  // one second at 20 Hz
    filter.predict(0.05);
    ASSERT_TRUE(filter.correctByGnss(0.3, 0.3, kGnssVariance));
  }
  // White noise would leave 3/sqrt(20) = 0.67 deg; the slow part, sqrt(0.8) * 3 = 2.7 deg, stays.
  EXPECT_GT(std::sqrt(filter.yawVariance()), 2.4 * kDeg);
  EXPECT_LT(std::sqrt(filter.yawVariance()), 3.0 * kDeg);
}

TEST(HeadingFilter, W9_NoisyGnssHeadingDoesNotPassOneToOne) {
  HeadingFilter filter({});
  filter.initializeFromGnss(kGnssVariance);
  for (int i = 0; i < 200; ++i) {
    filter.predict(0.05);
    ASSERT_TRUE(filter.correctByGnss(0.0, 0.0, kGnssVariance));
  }
  filter.predict(0.05);
  const Outcome<double> turn = filter.correctByGnss(0.0, 3.0 * kDeg, kGnssVariance);
  ASSERT_TRUE(turn);
  EXPECT_GT(*turn, 0.0);
  EXPECT_LT(*turn, 0.3 * kDeg);
}

TEST(HeadingFilter, TheFasterTheMoreTheVelocityCounts) {
  double last = 0.0;
  for (const double speed : {2.5, 5.0, 10.0, 20.0}) {
    HeadingFilter filter({});
    filter.initializeFromGnss(kGnssVariance);
    filter.predict(1.0);
    const Outcome<double> turn = filter.correctByVelocity(0.0, {0.05, std::pow(0.3 / speed, 2), speed, 0.0});
    ASSERT_TRUE(turn);
    EXPECT_GT(*turn, last);
    EXPECT_LT(*turn, 0.05);
    last = *turn;
  }
}

TEST(HeadingFilter, VelocityDominatesGnssAtSpeed) {
  HeadingFilter filter({});
  filter.initializeFromGnss(kGnssVariance);
  double yaw = 2.0 * kDeg;  // the receiver's slow error; the velocity says 0
  for (int i = 0; i < 200; ++i) {
    filter.predict(0.05);
    yaw += *filter.correctByGnss(yaw, 2.0 * kDeg, kGnssVariance);
    yaw += *filter.correctByVelocity(yaw, moving(0.0, 10.0));
  }
  EXPECT_NEAR(yaw, 0.0, 0.2 * kDeg);
}

TEST(HeadingFilter, W9_DrivingBackwardsDoesNotTurnTheHeading) {
  HeadingFilter filter({});
  filter.initializeFromGnss(kGnssVariance);
  filter.predict(1.0);
  const Outcome<double> turn = filter.correctByVelocity(0.1, moving(wrapAngle(0.12 + M_PI), 5.0));
  ASSERT_TRUE(turn);
  EXPECT_GT(*turn, 0.01);
  EXPECT_LT(*turn, 0.02);
}

TEST(HeadingFilter, VelocityOfAPointAheadOfTheAxleIsCorrectedInATurn) {
  HeadingParams params;
  params.imu_to_rear_axle_m = 1.3;
  params.imu_to_rear_axle_sigma_m = 0.0;
  HeadingFilter filter(params);
  const double yaw = 0.4, rate = 0.3, speed = 6.0;
  const double course = yaw + 1.3 * rate / speed;  // 3.7 deg beside the heading
  EXPECT_NEAR(filter.yawOf(moving(course, speed, rate)), yaw, 1e-12);
  filter.initializeFromGnss(kGnssVariance);
  filter.predict(1.0);
  EXPECT_NEAR(*filter.correctByVelocity(yaw, moving(course, speed, rate)), 0.0, 1e-12);
  // Backwards the same turn rate puts the course on the other side.
  const double backwards = wrapAngle(yaw + M_PI - 1.3 * rate / speed);
  EXPECT_NEAR(*filter.correctByVelocity(yaw, moving(backwards, speed, rate)), 0.0, 1e-12);
}

TEST(HeadingFilter, DistanceToTheAxleIsLearntInTurns) {
  HeadingParams params;
  params.imu_to_rear_axle_m = 1.3;
  params.imu_to_rear_axle_sigma_m = 0.7;
  HeadingFilter filter(params);
  filter.initializeFromVelocity(moving(0.0, 8.0), kGnssVariance);
  double error = 0.0;  // of the yaw
  for (int i = 0; i < 1200; ++i) {
    const double rate = 0.4 * std::sin(0.025 * i), speed = 8.0, true_distance = 0.3;
    filter.predict(0.05);
    const Outcome<double> turn =
        filter.correctByVelocity(error, moving(true_distance * rate / speed, speed, rate));
    ASSERT_TRUE(turn);
    error += *turn;
  }
  EXPECT_NEAR(filter.imuToRearAxle(), 0.3, 0.15);
  EXPECT_NEAR(error, 0.0, 0.2 * kDeg);
}

TEST(HeadingFilter, HeldByTheGyroscopeTheVarianceGrowsAsItsBiasSays) {
  HeadingParams params;
  HeadingFilter filter(params);
  filter.initializeFromGnss(kGnssVariance);
  for (int i = 0; i < 3000; ++i) filter.predict(0.01);
  const double grown = filter.yawVariance() - kGnssVariance;
  const double bias = params.gyroscope_bias_radps * 30.0, noise = params.gyroscope_noise_radps_sqrt_hz;
  const double walk = params.gyroscope_bias_walk_radps2_sqrt_hz;
  EXPECT_NEAR(grown, bias * bias + noise * noise * 30.0 + walk * walk * 27000.0 / 3.0, 1e-3 * grown);
}

TEST(HeadingFilter, GyroscopeBiasIsFoundWhileDriving) {
  HeadingFilter filter({});
  filter.initializeFromGnss(kGnssVariance);
  const double bias = 0.1 * kDeg;
  double error = 0.0;
  for (int i = 0; i < 1200; ++i) {
    error += 0.05 * (bias - filter.biasZ());
    filter.predict(0.05);
    error += *filter.correctByVelocity(error, moving(0.0, 10.0));
  }
  EXPECT_NEAR(filter.biasZ(), bias, 0.02 * kDeg);
}

TEST(HeadingFilter, OutlierIsRefusedAndChangesNothing) {
  HeadingFilter filter({});
  filter.initializeFromGnss(kGnssVariance);
  filter.predict(0.05);
  const double before = filter.yawVariance();
  const Outcome<double> turn = filter.correctByGnss(0.0, 90.0 * kDeg, kGnssVariance);
  ASSERT_FALSE(turn);
  EXPECT_EQ(turn.reason(), Reason::kLowQuality);
  EXPECT_EQ(filter.yawVariance(), before);
}

TEST(HeadingFilter, InnovationWrapsAtThePole) {
  HeadingFilter filter({});
  filter.initializeFromGnss(kGnssVariance);
  filter.predict(0.05);
  const Outcome<double> turn = filter.correctByGnss(M_PI - 0.01, -M_PI + 0.01, kGnssVariance);
  ASSERT_TRUE(turn);
  EXPECT_GT(*turn, 0.0);
  EXPECT_LT(*turn, 0.02);
}

TEST(HeadingFilter, ConsistentWithItsOwnModel) {
  // Truth drawn from the filter's model: bias, white and slow GNSS error, velocity headings now and then.
  HeadingParams params;
  double sum = 0.0;
  const int seeds = 200;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> n;
    HeadingFilter filter(params);
    const double white = std::sqrt(0.2 * kGnssVariance), slow_sigma = std::sqrt(0.8 * kGnssVariance);
    const double phi = std::exp(-0.05 / params.gnss_slow_time_s);
    double slow = slow_sigma * n(random), bias = params.gyroscope_bias_radps * n(random);
    double error = slow + white * n(random);  // estimate minus truth
    filter.initializeFromGnss(kGnssVariance);
    for (int i = 0; i < 600; ++i) {
      error +=
          0.05 * (bias - filter.biasZ()) + params.gyroscope_noise_radps_sqrt_hz * std::sqrt(0.05) * n(random);
      bias += params.gyroscope_bias_walk_radps2_sqrt_hz * std::sqrt(0.05) * n(random);
      slow = phi * slow + std::sqrt(1.0 - phi * phi) * slow_sigma * n(random);
      filter.predict(0.05);
      const Outcome<double> turn = filter.correctByGnss(error, slow + white * n(random), kGnssVariance);
      if (turn) error += *turn;
      if (i % 40 != 39) continue;  // two seconds apart: beyond the correlation of velocity errors
      const double sigma = std::hypot(0.005, params.slip_rad);
      const Outcome<double> by_velocity =
          filter.correctByVelocity(error, {sigma * n(random), 0.005 * 0.005, 10.0, 0.0});
      if (by_velocity) error += *by_velocity;
    }
    sum += error * error / filter.yawVariance();
  }
  EXPECT_NEAR(sum / seeds, 1.0, 1.96 * std::sqrt(2.0 / seeds));
}

}  // namespace
}  // namespace atlas
