// SPDX-License-Identifier: MIT
#include "atlas/localization/standing_gravity.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace atlas {
namespace {

constexpr double kG = 9.81;

ImuSample sampleAt(int i, const Eigen::Vector3d& a, const Eigen::Vector3d& w = Eigen::Vector3d::Zero()) {
  ImuSample sample;
  sample.stamp = i * 10 * kMillisecond;
  sample.linear_acceleration_mps2 = a;
  sample.angular_velocity_radps = w;
  return sample;
}

TEST(StandingGravity, MeansOverHalfASecondOfStandingOnceItIsConfirmed) {
  StandingGravity gravity;
  int answers = 0;
  for (int i = 0; i <= 152; ++i) {
    const double shake = i % 2 == 0 ? 0.2 : -0.2;  // an engine
    // blocks of 51 samples; the first one belongs to the braking, the last one to the next start
    const double motion = i < 51 ? 1.0 : i < 102 ? 0.0 : 0.7;
    const auto up = gravity.add(sampleAt(i, {shake + motion, 0.5, 9.79}), 0.0, kG);
    if (!up) continue;
    ++answers;
    EXPECT_EQ(i, 152);
    EXPECT_NEAR(up->direction_imu.y(), 0.5 / std::hypot(0.5, 9.79), 1e-4);
    EXPECT_NEAR(up->direction_imu.x(), 0.0, 1e-3);
    EXPECT_NEAR(up->span_s, 0.5, 1e-9);
  }
  EXPECT_EQ(answers, 1);
}

TEST(StandingGravity, SilentWhenMovingTurningAcceleratingOrUnknown) {
  struct Case {
    const char* name;
    Eigen::Vector3d a, w;
    std::optional<double> speed;
  };
  const Case cases[] = {
      {"moving", {0, 0, kG}, {0, 0, 0}, 3.0},
      {"turning", {0, 0, kG}, {0, 0, 0.1}, 0.0},
      {"braking", {-4, 0, kG}, {0, 0, 0}, 0.0},
      {"speed unknown", {0, 0, kG}, {0, 0, 0}, std::nullopt},
  };
  for (const Case& c : cases) {
    StandingGravity gravity;
    for (int i = 0; i < 400; ++i) EXPECT_FALSE(gravity.add(sampleAt(i, c.a, c.w), c.speed, kG)) << c.name;
  }
}

TEST(StandingGravity, AJoltStartsTheMeanAnew) {
  StandingGravity gravity;
  for (int i = 0; i < 150; ++i) EXPECT_FALSE(gravity.add(sampleAt(i, {0, 0, kG}), 0.0, kG));
  EXPECT_FALSE(gravity.add(sampleAt(150, {3, 0, kG + 3}), 0.0, kG));
  for (int i = 151; i < 303; ++i) EXPECT_FALSE(gravity.add(sampleAt(i, {0, 0, kG}), 0.0, kG)) << i;
  EXPECT_TRUE(gravity.add(sampleAt(303, {0, 0, kG}), 0.0, kG));
}

}  // namespace
}  // namespace atlas
