// SPDX-License-Identifier: MIT
#include "atlas/localization/imu_guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace atlas {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// A level IMU at 100 Hz with white noise, turning at `rate_radps`.
std::vector<ImuSample> noisy(int count, double rate_radps = 0.0) {
  std::mt19937 random(3);
  std::normal_distribution<double> n;
  std::vector<ImuSample> samples(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    ImuSample& s = samples[static_cast<std::size_t>(i)];
    s.stamp = kSecond + i * 10 * kMillisecond;
    s.angular_velocity_radps = 0.01 * Eigen::Vector3d(n(random), n(random), n(random));
    s.angular_velocity_radps.z() += rate_radps;
    s.linear_acceleration_mps2 = 0.1 * Eigen::Vector3d(n(random), n(random), n(random));
    s.linear_acceleration_mps2.z() += 9.81;
  }
  return samples;
}

/// How many samples are left out.
int leftOut(const std::vector<ImuSample>& samples, Counters& counters, const ImuGuardParams& params = {}) {
  ImuGuard guard(params, counters);
  return static_cast<int>(
      std::count_if(samples.begin(), samples.end(), [&](const ImuSample& s) { return !guard.usable(s); }));
}

std::string refusal(const std::vector<ImuSample>& samples) {
  Counters counters;
  try {
    leftOut(samples, counters);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TEST(ImuGuard, NothingIsLeftOutOfAGoodSignal) {
  Counters counters;
  EXPECT_EQ(leftOut(noisy(2000, 0.5), counters), 0);
  EXPECT_TRUE(counters.all().empty());
}

TEST(ImuGuard, GivenRangeIsSaturation) {
  auto samples = noisy(300);
  samples[100].linear_acceleration_mps2.x() = -49.0;
  samples[200].angular_velocity_radps.y() = 7.85;
  samples[210].angular_velocity_radps.y() = 7.7;  // inside
  Counters counters;
  EXPECT_EQ(leftOut(samples, counters, {49.0, 7.85, 0.2}), 2);
  EXPECT_EQ(counters.get("skipped imu: accelerometer saturated"), 1U);
  EXPECT_EQ(counters.get("skipped imu: gyroscope saturated"), 1U);
}

TEST(ImuGuard, RangeIsLearnedFromRepeatedExtremes) {
  auto samples = noisy(400);
  for (const std::size_t i : {100U, 101U, 102U, 103U, 250U}) samples[i].linear_acceleration_mps2.z() = 39.2;
  samples[300].linear_acceleration_mps2.z() = 30.0;  // a jolt below the range
  Counters counters;
  EXPECT_EQ(leftOut(samples, counters), 3);  // the third and fourth in a row, then the single one
  EXPECT_EQ(counters.get("skipped imu: accelerometer saturated"), 3U);
}

TEST(ImuGuard, DoubtGrowsWithTheLengthOfTheClipping) {
  auto samples = noisy(200);
  for (const std::size_t i : {100U, 101U, 102U}) samples[i].linear_acceleration_mps2.z() = 40.0;
  Counters counters;
  ImuGuard guard({40.0, 0.0, 0.2}, counters);
  double sum = 0.0;
  for (const ImuSample& s : samples) {
    guard.usable(s);
    sum += guard.doubt().velocity;
    EXPECT_EQ(guard.doubt().turn, 0.0);
  }
  EXPECT_NEAR(std::sqrt(sum), 3 * 0.01 * 40.0, 1e-9);  // the three periods are wrong in the same direction
}

TEST(ImuGuard, ALargerValueShowsThatItWasNoRange) {
  auto samples = noisy(400);
  for (const std::size_t i : {100U, 101U, 102U}) samples[i].linear_acceleration_mps2.z() = 25.0;
  samples[200].linear_acceleration_mps2.z() = 31.0;
  samples[210].linear_acceleration_mps2.z() = 25.0;
  Counters counters;
  EXPECT_EQ(leftOut(samples, counters), 1);
}

TEST(ImuGuard, GravityRepeatedExactlyIsNoSaturation) {
  auto samples = noisy(400);
  for (ImuSample& s : samples) s.linear_acceleration_mps2.z() = 9.81;
  Counters counters;
  EXPECT_EQ(leftOut(samples, counters), 0);
}

TEST(ImuGuard, FrozenSignalIsLeftOutUntilItMovesAgain) {
  auto samples = noisy(400);
  for (std::size_t i = 200; i < 300; ++i) {
    samples[i].angular_velocity_radps = samples[199].angular_velocity_radps;
    samples[i].linear_acceleration_mps2 = samples[199].linear_acceleration_mps2;
  }
  Counters counters;
  EXPECT_EQ(leftOut(samples, counters), 81);  // 0.2 s after sample 199: from sample 219 on
  EXPECT_EQ(counters.get("skipped imu: frozen, the same values again and again"), 81U);
  Counters never;
  EXPECT_EQ(leftOut(samples, never, {0.0, 0.0, 0.0}), 0);
}

TEST(ImuGuard, ASignalThatNeverVariedIsASimulationAndNotFrozen) {
  std::vector<ImuSample> samples(500, noisy(1)[0]);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].stamp = kSecond + static_cast<Stamp>(i) * 10 * kMillisecond;
  Counters counters;
  EXPECT_EQ(leftOut(samples, counters), 0);
}

TEST(ImuGuard, GapsAreCountedWithTheirLength) {
  auto samples = noisy(400);
  for (std::size_t i = 200; i < samples.size(); ++i) samples[i].stamp += 300 * kMillisecond;
  Counters counters;
  EXPECT_EQ(leftOut(samples, counters), 0);
  EXPECT_EQ(counters.get("imu gaps"), 1U);
  EXPECT_EQ(counters.get("imu gaps, ms altogether"), 310U);
}

TEST(ImuGuard, ImpossibleValuesAreLeftOut) {
  auto samples = noisy(100);
  samples[50].linear_acceleration_mps2.y() = 1e6;
  samples[60].angular_velocity_radps.z() = -1e3;
  Counters counters;
  EXPECT_EQ(leftOut(samples, counters), 2);
  EXPECT_EQ(counters.get("skipped imu: acceleration beyond 200 m/s^2"), 1U);
  EXPECT_EQ(counters.get("skipped imu: turn rate beyond 40 rad/s"), 1U);
}

TEST(ImuGuard, AccelerationsInGAreRefused) {
  auto samples = noisy(400);
  for (ImuSample& s : samples) s.linear_acceleration_mps2 /= 9.81;
  EXPECT_TRUE(has(refusal(samples), "in g; m/s^2 is needed")) << refusal(samples);
}

TEST(ImuGuard, AccelerationsWithoutGravityAreRefused) {
  auto samples = noisy(400);
  for (ImuSample& s : samples) s.linear_acceleration_mps2.z() -= 9.81;
  EXPECT_TRUE(has(refusal(samples), "not gravity")) << refusal(samples);
}

TEST(ImuGuard, GravityPointingDownIsRefused) {
  auto samples = noisy(400);
  for (ImuSample& s : samples) s.linear_acceleration_mps2 *= -1.0;
  EXPECT_TRUE(has(refusal(samples), "must point up")) << refusal(samples);
}

TEST(ImuGuard, RatesInDegreesAreRefusedAtTheFirstTurn) {
  auto samples = noisy(1000, 0.2);
  for (ImuSample& s : samples) s.angular_velocity_radps /= kDegree;
  EXPECT_TRUE(has(refusal(samples), "in degrees?")) << refusal(samples);
}

TEST(ImuGuard, SlowTurnsInDegreesAreSeenAgainstTheOwnOrientation) {
  auto samples = noisy(1000, 0.06);  // 3.4 deg/s: as rad/s still possible
  double yaw = 0.0;
  for (ImuSample& s : samples) {
    yaw += 0.01 * 0.06;
    s.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  }
  EXPECT_EQ(refusal(samples), "");
  for (ImuSample& s : samples) s.angular_velocity_radps /= kDegree;
  EXPECT_TRUE(has(refusal(samples), "own orientation")) << refusal(samples);
}

TEST(ImuGuard, WrongParametersAreNamed) {
  try {
    validate(ImuGuardParams{0.0, -1.0, 0.2});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_TRUE(has(error.what(), "gyroscope_range_radps"));
  }
}

}  // namespace
}  // namespace atlas
