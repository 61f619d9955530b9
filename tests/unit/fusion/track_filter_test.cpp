// SPDX-License-Identifier: MIT
#include "atlas/fusion/track_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <random>

namespace atlas {
namespace {

LinearRow position(int index, double z, double sigma) {
  LinearRow row;
  row.h(index) = 1.0;
  row.z = z;
  row.variance = sigma * sigma;
  return row;
}
TrackState born(double x, double y) {
  TrackState state;
  state.mean << x, y, 0.0, 0.0, 0.0, 4.0, 1.8;
  state.covariance = (TrackVector() << 0.04, 0.04, 100.0, 100.0, 0.25, 0.1, 0.1).finished().asDiagonal();
  return state;
}
std::shared_ptr<const MotionModels> models() { return std::make_shared<const MotionModels>(motionModels()); }

/// Follows positions measured with 0.1 m, 10 times a second.
TrackFilter follow(const std::function<Eigen::Vector2d(double)>& path, double duration_s,
                   const MotionProfile& profile) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.1);
  TrackFilter filter(models(), born(path(0.0).x(), path(0.0).y()), profile);
  for (double t = 0.1; t < duration_s; t += 0.1) {
    filter.predict(0.1, profile);
    Rows rows;
    rows.add(position(kPx, path(t).x() + noise(random), 0.1));
    rows.add(position(kPy, path(t).y() + noise(random), 0.1));
    filter.update(rows, 0.0);
  }
  return filter;
}

TEST(TrackFilter, OneRowByHand) {
  MotionProfile profile;
  TrackFilter filter(models(), born(0.0, 0.0), profile);
  Rows rows;
  rows.add(position(kPx, 1.0, 0.2));
  const RowDistance distance = distanceOf(filter.estimate(), rows);
  EXPECT_NEAR(distance.mahalanobis_sq, 1.0 / 0.08, 1e-9);
  EXPECT_NEAR(distance.log_determinant, std::log(0.08), 1e-9);
  filter.update(rows, 0.0);
  EXPECT_NEAR(filter.estimate().mean(kPx), 0.5, 1e-9);
  EXPECT_NEAR(filter.estimate().covariance(kPx, kPx), 0.02, 1e-9);
}

TEST(TrackFilter, KnowsHowAnObjectMoves) {
  const MotionProfile profile;
  const TrackFilter stands = follow([](double) { return Eigen::Vector2d(3.0, 4.0); }, 3.0, profile);
  EXPECT_GT(stands.standingProbability(), 0.95);
  const TrackFilter drives = follow([](double t) { return Eigen::Vector2d(10.0 * t, 0.0); }, 3.0, profile);
  EXPECT_LT(drives.standingProbability(), 0.01);
  EXPECT_NEAR(drives.estimate().mean(kVx), 10.0, 3.0 * std::sqrt(drives.estimate().covariance(kVx, kVx)));
  const auto circle = [](double t) {
    return Eigen::Vector2d(20.0 * std::sin(0.5 * t), 20.0 - 20.0 * std::cos(0.5 * t));
  };
  const TrackFilter turns = follow(circle, 6.0, profile);
  EXPECT_GT(turns.probabilities()[2], turns.probabilities()[1]) << "turning beats driving straight";
  EXPECT_NEAR(turns.estimate().mean.segment<2>(kVx).norm(), 10.0, 0.7);
  const TrackFilter walks = follow([](double t) { return Eigen::Vector2d(1.2 * t, 0.0); }, 3.0, profile);
  EXPECT_LT(walks.standingProbability(), 0.5) << "a walker is not taken for noise";
}

/// The normalized estimation error squared of position and velocity has the mean 4 when the covariance is
/// true; 200 runs of 30 updates with accelerations drawn as the filter assumes.
TEST(TrackFilter, CovarianceIsTrue) {
  MotionProfile profile;
  profile.weights = {0.0, 1.0, 0.0};
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  int count = 0;
  for (int run = 0; run < 200; ++run) {
    Eigen::Vector4d truth(0.0, 0.0, 10.0 * normal(random), 10.0 * normal(random));
    TrackState start = born(0.2 * normal(random), 0.2 * normal(random));
    TrackFilter filter(models(), start, profile);
    const double q = profile.noise.acceleration_mps2_sqrt_s, dt = 0.1;
    for (int k = 0; k < 30; ++k) {
      for (int axis = 0; axis < 2; ++axis) {  // Cholesky factor of the noise of position and velocity
        const double a = normal(random), b = normal(random);
        truth(axis) += dt * truth(2 + axis) + q * std::sqrt(dt * dt * dt / 3.0) * a;
        truth(2 + axis) += q * std::sqrt(dt) * (0.5 * std::sqrt(3.0) * a + 0.5 * b);
      }
      filter.predict(dt, profile);
      Rows rows;
      rows.add(position(kPx, truth(0) + 0.1 * normal(random), 0.1));
      rows.add(position(kPy, truth(1) + 0.1 * normal(random), 0.1));
      filter.update(rows, 0.0);
      if (k < 5) continue;
      const Eigen::Vector4d error = filter.estimate().mean.head<4>() - truth;
      const Eigen::Matrix4d P = filter.estimate().covariance.topLeftCorner<4, 4>();
      sum += error.dot(P.ldlt().solve(error));
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 4.0, 0.5) << "chi-square of 4 degrees, 5000 correlated samples";
}

TEST(TrackFilter, FarRowsWeighLess) {
  const MotionProfile profile;
  TrackFilter trusting(models(), born(0.0, 0.0), profile), doubting = trusting;
  Rows rows;
  rows.add(position(kPx, 5.0, 0.1));
  trusting.update(rows, 0.0);
  doubting.update(rows, 2.5);
  EXPECT_LT(doubting.estimate().mean(kPx), 0.5 * trusting.estimate().mean(kPx));
}

TEST(TrackFilter, RefusesProfilesThatMakeNoSense) {
  MotionProfile profile;
  profile.weights = {0.5, 0.5};
  EXPECT_THROW(validate(profile, 3), std::invalid_argument);
  profile.weights = {0.0, 0.0, 0.0};
  EXPECT_THROW(validate(profile, 3), std::invalid_argument);
  profile.weights = {1.0, -0.1, 0.0};
  EXPECT_THROW(validate(profile, 3), std::invalid_argument);
}

TEST(TrackFilter, AnotherWayToMoveIsOneMoreEntry) {
  MotionModels more = motionModels();
  more.push_back({"drifts", false,
                  [](TrackState& state, double dt, const MotionNoise&) { state.mean(kPx) += 2.0 * dt; }});
  MotionProfile profile;
  profile.weights = {0.0, 0.0, 0.0, 1.0};
  TrackFilter filter(std::make_shared<const MotionModels>(more), born(0.0, 0.0), profile);
  filter.predict(1.0, profile);
  EXPECT_NEAR(filter.estimate().mean(kPx), 2.0, 1e-3);
}

}  // namespace
}  // namespace atlas
