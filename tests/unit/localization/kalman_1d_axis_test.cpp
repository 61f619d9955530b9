// SPDX-License-Identifier: MIT
#include "atlas/localization/kalman_1d_axis.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

namespace atlas {
namespace {

constexpr double kNoBias = 0.0;

TEST(Kalman1dAxis, OneStepByHand) {
  Kalman1dAxis axis;
  axis.initialize(1.0, 4.0, 2.0, 9.0, kNoBias);
  axis.predict(0.5, {3.0, 0.6, 0.0, 60.0});
  // p = 1 + 0.5*2 + 0.125*3 = 2.375, v = 2 + 0.5*3 = 3.5
  EXPECT_NEAR(axis.position(), 2.375, 1e-12);
  EXPECT_NEAR(axis.velocity(), 3.5, 1e-12);
  // P = [4+0.25*9, 0.5*9; ., 9] + 0.6*[0.125/3, 0.125; 0.125, 0.5] = [6.275, 4.575; ., 9.3]
  EXPECT_NEAR(axis.covariance()(0, 0), 6.275, 1e-12);
  EXPECT_NEAR(axis.covariance()(0, 1), 4.575, 1e-12);
  EXPECT_NEAR(axis.covariance()(1, 1), 9.3, 1e-12);
  // S = 6.275 + 0.1 = 6.375; K = [6.275, 4.575]/6.375; innovation 1
  axis.correct(3.375, 0.1);
  EXPECT_NEAR(axis.position(), 2.375 + 6.275 / 6.375, 1e-12);
  EXPECT_NEAR(axis.velocity(), 3.5 + 4.575 / 6.375, 1e-12);
  // (I - KH) P
  EXPECT_NEAR(axis.covariance()(0, 0), 6.275 * 0.1 / 6.375, 1e-12);
  EXPECT_NEAR(axis.covariance()(0, 1), 4.575 * 0.1 / 6.375, 1e-12);
  EXPECT_NEAR(axis.covariance()(1, 1), 9.3 - 4.575 * 4.575 / 6.375, 1e-12);
}

TEST(Kalman1dAxis, SlowErrorOfOneStepByHand) {
  Kalman1dAxis axis;
  axis.initialize(0.0, 0.0, 0.0, 0.0, 4.0);
  axis.predict(2.0, {0.0, 0.0, 4.0, 1e9});  // dp = b dt^2/2 = 2 b, dv = b dt = 2 b
  EXPECT_NEAR(axis.covariance()(0, 0), 16.0, 1e-9);
  EXPECT_NEAR(axis.covariance()(0, 1), 16.0, 1e-9);
  EXPECT_NEAR(axis.covariance()(1, 1), 16.0, 1e-9);
}

TEST(Kalman1dAxis, W7_VelocityGainIsCrossCovarianceOverWholeInnovationVariance) {
  // The published program divided element by element, so that its velocity gain was p12/R: 0.500 instead of
  // 0.045.
  Kalman1dAxis axis;
  axis.initialize(0.0, 1.0, 0.0, 1.0, kNoBias);
  axis.predict(0.05, {0.0, 1e-12, 0.0, 60.0});
  axis.correct(1.0, 0.1);
  const double p11 = 1.0 + 0.05 * 0.05, p12 = 0.05;
  EXPECT_NEAR(axis.velocity(), p12 / (p11 + 0.1), 1e-9);
  EXPECT_NEAR(axis.velocity(), 0.045, 5e-4);
}

TEST(Kalman1dAxis, W7_TenMetresPerSecondFromUnknownVelocityIsFoundAtOnce) {
  // The published filter was 1.25 m off and at -2.4 m/s in the first second.
  Kalman1dAxis axis;
  axis.initialize(0.0, 4e-4, 0.0, 900.0, kNoBias);
  for (int i = 1; i <= 20; ++i) {
    axis.predict(0.05, {0.0, 0.0025, 0.0, 60.0});
    axis.correct(10.0 * 0.05 * i, 4e-4);
    EXPECT_NEAR(axis.position(), 10.0 * 0.05 * i, 1e-3);
    EXPECT_NEAR(axis.velocity(), 10.0, 0.01);
  }
}

TEST(Kalman1dAxis, W8_NoiseDoesNotDependOnTheRate) {
  const auto after = [](int steps, double bias_variance) {
    Kalman1dAxis axis;
    axis.initialize(0.0, 0.01, 0.0, 0.04, bias_variance);
    for (int i = 0; i < steps; ++i) axis.predict(1.0 / steps, {0.3, 0.0025, bias_variance, 20.0});
    return axis;
  };
  const Kalman1dAxis one = after(1, 0.0), slow = after(100, 0.0), fast = after(400, 0.0);
  EXPECT_LT((slow.covariance() - fast.covariance()).norm(), 1e-12);  // exact for white noise
  EXPECT_LT((one.covariance() - fast.covariance()).norm(), 1e-12);
  EXPECT_NEAR(slow.position(), fast.position(), 1e-12);
  const Kalman1dAxis slow_bias = after(100, 0.01), fast_bias = after(400, 0.01);  // held within a step
  EXPECT_LT((slow_bias.covariance() - fast_bias.covariance()).norm(), 1e-3 * fast_bias.covariance().norm());
}

TEST(Kalman1dAxis, MahalanobisCountsBothUncertainties) {
  Kalman1dAxis axis;
  axis.initialize(2.0, 3.0, 0.0, 1.0, kNoBias);
  EXPECT_NEAR(axis.mahalanobisSq(6.0, 1.0), 4.0, 1e-12);
}

TEST(Kalman1dAxis, ShiftMovesAndAddsUncertainty) {
  Kalman1dAxis axis;
  axis.initialize(2.0, 3.0, 1.0, 1.0, kNoBias);
  axis.shift(-0.5, 0.25, 0.125, 0.01);
  EXPECT_DOUBLE_EQ(axis.position(), 1.5);
  EXPECT_DOUBLE_EQ(axis.velocity(), 1.125);
  EXPECT_DOUBLE_EQ(axis.covariance()(0, 0), 3.25);
}

TEST(Kalman1dAxis, W7_StaysSymmetricAndPositiveUnderTinyMeasurementNoise) {
  Kalman1dAxis axis;
  axis.initialize(0.0, 1e6, 0.0, 1e6, 1e-3);
  for (int i = 0; i < 20000; ++i) {
    axis.predict(0.0025, {0.1, 1e-6, 1e-3, 60.0});
    if (i % 20 == 0) axis.correct(0.0, 1e-10);
    const Eigen::Matrix2d P = axis.covariance();
    ASSERT_EQ(P(0, 1), P(1, 0));
    ASSERT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(P).eigenvalues()(0), 0.0);
  }
}

/// Average of the normalized squared error of (p, v) over time and `seeds` runs of the filter's own model.
double averageNees(int seeds, double q, double bias_sigma, double bias_time_s, double declared_q) {
  const double dt = 0.01, r = 4e-4, phi = std::exp(-dt / bias_time_s);
  double sum = 0.0;
  int n = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed) + 1U);
    std::normal_distribution<double> normal;
    double p = 0.3 * normal(random), v = 2.0 * normal(random), b = bias_sigma * normal(random);
    Kalman1dAxis axis;
    axis.initialize(0.0, 0.09, 0.0, 4.0, bias_sigma * bias_sigma);
    for (int i = 1; i <= 3000; ++i) {
      // Exact discretization of white acceleration noise: correlated increments of p and v.
      const double wv = std::sqrt(q * dt) * normal(random);
      const double wp = 0.5 * dt * wv + std::sqrt(q * dt * dt * dt / 12.0) * normal(random);
      const double u = std::sin(0.01 * i);
      p += dt * v + 0.5 * dt * dt * (u + b) + wp;
      v += dt * (u + b) + wv;
      b = phi * b + std::sqrt(1.0 - phi * phi) * bias_sigma * normal(random);
      axis.predict(dt, {u, declared_q, bias_sigma * bias_sigma, bias_time_s});
      if (i % 5 == 0) axis.correct(p + std::sqrt(r) * normal(random), r);
      if (i > 1000 && i % 1000 == 0) {  // ten seconds apart: independent samples
        const Eigen::Vector2d e(axis.position() - p, axis.velocity() - v);
        sum += e.dot(axis.covariance().inverse() * e);
        ++n;
      }
    }
  }
  return sum / n;
}

// n runs x 2 samples of 2 degrees of freedom: variance of the mean of m chi-square(2) samples is 4/m.
TEST(Kalman1dAxis, ConsistentWithItsOwnModel) {
  const int seeds = 100, samples = 2 * seeds;
  const double bound = 1.96 * std::sqrt(4.0 / samples);
  EXPECT_NEAR(averageNees(seeds, 0.0025, 0.0, 60.0, 0.0025), 2.0, bound);
  EXPECT_NEAR(averageNees(seeds, 0.0025, 0.05, 5.0, 0.0025), 2.0,
              bound);  // with a slow error that is considered
}

TEST(Kalman1dAxis, ConsistencyTestSeesAWrongNoise) {
  const double bound = 1.96 * std::sqrt(4.0 / 200);
  EXPECT_GT(averageNees(100, 0.0025, 0.0, 60.0, 0.0025 / 16.0), 2.0 + bound);
  EXPECT_LT(averageNees(100, 0.0025, 0.0, 60.0, 0.0025 * 64.0), 2.0 - bound);
}

TEST(Kalman1dAxis, AnOutageIsNotUnderestimated) {
  // A constant acceleration error of one sigma, ten seconds without a fix: the error is half a metre per 0.01
  // m/s^2.
  Kalman1dAxis axis;
  axis.initialize(0.0, 1e-4, 0.0, 1e-4, 0.05 * 0.05);
  for (int i = 0; i < 1000; ++i) axis.predict(0.01, {0.0, 0.0001, 0.05 * 0.05, 1e6});
  const double error = 0.5 * 0.05 * 100.0;
  EXPECT_GT(std::sqrt(axis.covariance()(0, 0)), error);
  EXPECT_LT(std::sqrt(axis.covariance()(0, 0)), 1.1 * error);
}

}  // namespace
}  // namespace atlas
