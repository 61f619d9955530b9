// SPDX-License-Identifier: MIT
#include "atlas/localization/attitude_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "atlas/base/geometry.hpp"

namespace atlas {
namespace {

constexpr double kDeg = M_PI / 180.0;
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

Eigen::Vector3d upOf(const Eigen::Quaterniond& R_map_imu) { return R_map_imu.conjugate() * kUp; }

TEST(AttitudeModel, StartsWithRollAndPitchButNoYaw) {
  const Eigen::Quaterniond truth = fromRollPitchYaw({0.1, -0.2, 2.5});
  AttitudeModel model({});
  EXPECT_FALSE(model.known());
  model.initialize(upOf(truth));
  EXPECT_TRUE(model.known());
  const RollPitchYaw rpy = toRollPitchYaw(model.R_map_imu());
  EXPECT_NEAR(rpy.roll, 0.1, 1e-12);
  EXPECT_NEAR(rpy.pitch, -0.2, 1e-12);
  EXPECT_NEAR(rpy.yaw, 0.0, 1e-12);
  model.setYaw(2.5);
  EXPECT_LT(model.R_map_imu().angularDistance(truth), 1e-9);
}

TEST(AttitudeModel, IntegratesARateThatChangesLinearly) {
  AttitudeModel model({});
  model.initialize(kUp);
  for (int i = 0; i < 100; ++i) {  // w = t rad/s about z: angle t^2/2
    model.integrate({0, 0, 0.01 * i}, {0, 0, 0.01 * (i + 1)}, 0.01);
  }
  EXPECT_NEAR(model.yaw(), 0.5, 1e-12);
}

TEST(AttitudeModel, LowPassHasItsTimeConstantAtAnyRate) {
  const auto rollAfterOneTimeConstant = [](int rate_hz) {
    AttitudeModel model({});
    model.initialize(kUp);
    const Eigen::Vector3d measured = upOf(fromRollPitchYaw({2.0 * kDeg, 0, 0}));
    const int steps = 5 * rate_hz / 2;
    for (int i = 0; i < steps; ++i) {
      model.integrate(model.bias_radps(), model.bias_radps(), 1.0 / rate_hz);  // no rotation
      model.correctTilt(measured, kUp, 1.0 / rate_hz);
    }
    return toRollPitchYaw(model.R_map_imu()).roll / (2.0 * kDeg);
  };
  const double slow = rollAfterOneTimeConstant(100), fast = rollAfterOneTimeConstant(400);
  EXPECT_NEAR(slow, 1.0 - std::exp(-1.0), 1e-3);
  EXPECT_NEAR(fast, slow, 1e-3);
}

TEST(AttitudeModel, TheImusOwnYawNeverEnters) {
  AttitudeModel model({});
  model.initialize(kUp);
  model.setYaw(0.7);
  const Eigen::Vector3d measured = upOf(fromRollPitchYaw({0.02, -0.03, -2.9}));
  for (int i = 0; i < 5000; ++i) {
    model.integrate(model.bias_radps(), model.bias_radps(), 0.01);
    model.correctTilt(measured, kUp, 0.01);
  }
  const RollPitchYaw rpy = toRollPitchYaw(model.R_map_imu());
  EXPECT_NEAR(rpy.roll, 0.02, 1e-6);
  EXPECT_NEAR(rpy.pitch, -0.03, 1e-6);
  EXPECT_NEAR(rpy.yaw, 0.7,
              0.03 * 0.03);  // the shortest correction turns yaw by less than the square of the tilt
}

TEST(AttitudeModel, LevelGyroscopeBiasIsFoundAndLeavesNoTilt) {
  AttitudeModel model({});
  model.initialize(kUp);
  const Eigen::Vector3d bias(0.5 * kDeg, -0.3 * kDeg, 0.0);
  for (int i = 0; i < 40000; ++i) {
    model.integrate(bias, bias, 0.01);
    model.correctTilt(kUp, kUp, 0.01);
  }
  EXPECT_LT((model.bias_radps() - bias).norm(), 0.001 * kDeg);
  const RollPitchYaw rpy = toRollPitchYaw(model.R_map_imu());
  EXPECT_NEAR(rpy.roll, 0.0, 0.01 * kDeg);  // a plain low-pass would lean by bias * tau = 1.25 deg
  EXPECT_NEAR(rpy.pitch, 0.0, 0.01 * kDeg);
}

TEST(AttitudeModel, TiltVarianceGrowsWithoutAndSettlesWithMeasurements) {
  AttitudeParams params;
  AttitudeModel model(params);
  model.initialize(kUp);
  const double start = model.tiltVariance();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) model.integrate(zero, zero, 0.01);
  const double bias_angle = params.gyroscope_bias_radps * 10.0;
  EXPECT_NEAR(model.tiltVariance() - start,
              bias_angle * bias_angle + std::pow(params.gyroscope_noise_radps_sqrt_hz, 2) * 10.0, 1e-9);
  for (int i = 0; i < 5000; ++i) {
    model.integrate(zero, zero, 0.01);
    model.correctTilt(kUp, kUp, 0.01);
  }
  EXPECT_NEAR(std::sqrt(model.tiltVariance()), params.tilt_sigma_rad, 0.1 * params.tilt_sigma_rad);
}

}  // namespace
}  // namespace atlas
