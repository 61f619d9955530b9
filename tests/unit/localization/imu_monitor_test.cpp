// SPDX-License-Identifier: MIT
#include "atlas/localization/imu_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace atlas {
namespace {

ImuSample sampleAt(int i, double gyro, double force) {
  ImuSample sample;
  sample.stamp = kSecond + i * 10 * kMillisecond;
  sample.angular_velocity_radps.setConstant(gyro);
  sample.linear_acceleration_mps2 = Eigen::Vector3d(force, force, 9.81 + force);
  return sample;
}

TEST(ImuMonitor, BlockOfAConstantSignal) {
  ImuMonitor monitor;
  std::optional<ImuMonitor::Block> block;
  int i = 0;
  for (; !block; ++i) block = monitor.add(sampleAt(i, 0.02, 0.1));
  EXPECT_EQ(i, 21);  // 0.2 s at 100 Hz
  EXPECT_NEAR(block->gyro_radps.x(), 0.02, 1e-12);
  EXPECT_NEAR(block->force_mps2.z(), 9.91, 1e-12);
  EXPECT_NEAR(block->gyro_spread_radps, 0.0, 1e-9);
  EXPECT_EQ(monitor.gyroDensity(), 0.0);
}

TEST(ImuMonitor, DensityOfWhiteNoiseAndNotOfMotion) {
  std::mt19937 random(1);
  std::normal_distribution<double> n;
  ImuMonitor monitor;
  for (int i = 0; i < 2000; ++i) {
    ImuSample sample = sampleAt(i, std::sin(0.01 * i), std::cos(0.02 * i));
    for (int k = 0; k < 3; ++k) {
      sample.angular_velocity_radps(k) += 0.01 * n(random);
      sample.linear_acceleration_mps2(k) += 0.1 * n(random);
    }
    monitor.add(sample);
  }
  EXPECT_NEAR(monitor.gyroDensity(), 0.01 * 0.1, 0.0002);  // sigma sqrt(dt); mean of about 300 values
  EXPECT_NEAR(monitor.forceDensity(), 0.1 * 0.1, 0.002);
}

}  // namespace
}  // namespace atlas
