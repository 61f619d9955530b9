// SPDX-License-Identifier: MIT
// Every Jacobian of the error-state filter against numeric differences of the function it belongs to.
#include <gtest/gtest.h>

#include <random>

#include "atlas/localization/eskf_measurement.hpp"
#include "atlas/localization/eskf_motion.hpp"

namespace atlas::eskf {
namespace {

const Geodetic kAnchor{49.2, 16.6, 280.0};

State someState(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> n;
  const auto vector = [&](double sigma) {
    const double x = n(random), y = n(random), z = n(random);
    return Eigen::Vector3d(sigma * x, sigma * y, sigma * z);
  };
  State s;
  s.p = vector(50.0);
  s.v = vector(8.0);
  s.R = expSo3(vector(1.0));
  s.gyro_bias = vector(0.01);
  s.accel_bias = vector(0.1);
  s.heading_slow_rad = 0.02;
  s.mounted_rad = 0.6;
  s.mount_yaw = 0.05;
  s.mount_pitch = -0.04;
  s.axle_m = 1.2;
  s.lever = vector(0.7);
  s.delay_s = 0.04;
  return s;
}
const Eigen::Vector3d kRate(0.1, -0.2, 0.4), kForce(0.5, -1.0, 9.6);

/// Columns d(y)/d(error) by central differences; y = z - h, so H is their negative.
template <int M, class Measure>
void expectJacobian(const State& state, const Measure& measure) {
  const Measurement<M> z = measure(state);
  for (int i = 0; i < kSize; ++i) {
    const double step = 1e-6;
    Vector error = Vector::Zero();
    error(i) = step;
    State plus = state, minus = state;
    inject(plus, error);
    inject(minus, -error);
    const Eigen::Matrix<double, M, 1> numeric = -(measure(plus).y - measure(minus).y) / (2.0 * step);
    EXPECT_LT((numeric - z.H.col(i)).norm(), 1e-6 * (1.0 + numeric.norm())) << "error " << i;
  }
}

TEST(EskfJacobian, Fix) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    expectJacobian<3>(someState(seed), [](const State& s) {
      return fixMeasurement(s, kRate - s.gyro_bias, {3.0, -4.0, 1.0}, Eigen::Matrix3d::Identity());
    });
  }
}

TEST(EskfJacobian, Heading) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    State state = someState(seed);
    state.R = fromRollPitchYaw({0.1, -0.2, 0.5 * seed});
    expectJacobian<1>(state, [](const State& s) { return headingMeasurement(s, 0.3, 0.01); });
  }
}

TEST(EskfJacobian, Wheels) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    expectJacobian<2>(someState(seed),
                      [](const State& s) { return wheelsMeasurement(s, kRate - s.gyro_bias, 0.01, 0.02); });
  }
}

TEST(EskfJacobian, StandingAndNotTurning) {
  const Earth earth(kAnchor);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    expectJacobian<3>(someState(seed), [](const State& s) { return standingMeasurement(s, 1e-4); });
    expectJacobian<3>(someState(seed),
                      [&](const State& s) { return notTurningMeasurement(s, earth, kRate, 1e-6); });
  }
}

TEST(EskfJacobian, UpNearTheMeasurement) {
  // The model is of first order in the misfit: exact where the measurement agrees.
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const State state = someState(seed);
    const Eigen::Vector3d up_imu = state.R.conjugate() * Eigen::Vector3d::UnitZ();
    expectJacobian<2>(
        state, [&](const State& s) { return upMeasurement(s, up_imu, Eigen::Vector3d::UnitZ(), 1e-4); });
  }
}

TEST(EskfJacobian, Transition) {
  const Earth earth(kAnchor);
  const double dt = 0.01;
  const Inertial first{kRate, kForce}, second{1.1 * kRate, 0.9 * kForce};
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const State before = someState(seed);
    State nominal = before;
    const Transition transition = move(nominal, earth, first, second, dt, 20.0);
    Matrix phi = Matrix::Identity();
    transition.apply<kSize>(phi);
    for (int i = 0; i < kAccel + 3; ++i) {
      const double step = 1e-5;
      Vector error = Vector::Zero();
      error(i) = step;
      State moved = before;
      inject(moved, error);
      move(moved, earth, first, second, dt, 20.0);
      Vector numeric = Vector::Zero();
      numeric.segment<3>(kP) = (moved.p - nominal.p) / step;
      numeric.segment<3>(kV) = (moved.v - nominal.v) / step;
      numeric.segment<3>(kTheta) = logSo3(moved.R * nominal.R.conjugate()) / step;
      numeric.segment<3>(kGyro) = (moved.gyro_bias - nominal.gyro_bias) / step;
      numeric.segment<3>(kAccel) = (moved.accel_bias - nominal.accel_bias) / step;
      // Left out on purpose: Coriolis and the Earth's turn of theta (1e-6), the rotation within a step, which
      // is of second order in dt: 0.5 * 0.46 rad/s * dt^2 * 10 m/s^2.
      EXPECT_LT((numeric - phi.col(i)).head<15>().norm(), 5e-4) << "error " << i;
      EXPECT_LT((numeric - phi.col(i)).head<15>().norm(), 0.02 * numeric.norm()) << "error " << i;
    }
  }
}

TEST(EskfMotion, CovarianceByBlocksIsPhiPPhiTransposedPlusQ) {
  const Earth earth(kAnchor);
  State state = someState(7);
  const Matrix A = Matrix::Random();
  Matrix P = A * A.transpose();
  const Transition transition = move(state, earth, {kRate, kForce}, {kRate, kForce}, 0.02, 20.0);
  Matrix phi = Matrix::Identity();
  transition.apply<kSize>(phi);
  const Matrix expected = phi * P * phi.transpose();
  moveCovariance(P, transition, ProcessNoise{});
  EXPECT_LT((P - expected).norm(), 1e-9 * expected.norm());
  EXPECT_LT((P - P.transpose()).norm(), 1e-12 * P.norm());
}

TEST(EskfMotion, AtRestNothingMoves) {
  // What an IMU at rest on the rotating Earth measures keeps it at rest: signs of gravity, Earth rate,
  // Coriolis.
  const Earth earth(kAnchor);
  State state;
  state.R = fromRollPitchYaw({0.05, -0.03, 1.0});
  const State begin = state;
  const Inertial rest{state.R.conjugate() * earth.rotation_radps,
                      state.R.conjugate() * earth.gravity({0, 0, 0})};
  for (int i = 0; i < 6000; ++i) move(state, earth, rest, rest, 0.01, 20.0);
  EXPECT_LT(state.p.norm(), 1e-6);
  EXPECT_LT(logSo3(state.R * begin.R.conjugate()).norm(), 1e-9);
}

}  // namespace
}  // namespace atlas::eskf
