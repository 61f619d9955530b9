// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "atlas/fusion/track_filter.hpp"

namespace atlas {
namespace {

TrackState born(double x, double y) {
  TrackState state;
  state.mean << x, y, 0.0, 0.0, 0.0, 4.0, 1.8;
  state.covariance = (TrackVector() << 0.04, 0.04, 100.0, 100.0, 0.25, 0.1, 0.1).finished().asDiagonal();
  return state;
}
TEST(MotionModels, JacobianOfTheTurnIsItsDerivative) {
  for (const double w : {0.0, 1e-6, 0.3, -0.8}) {
    TrackState state = born(1.0, 2.0);
    state.mean(kVx) = 7.0;
    state.mean(kVy) = -3.0;
    state.mean(kTurnRate) = w;
    state.covariance.setIdentity();
    const MotionNoise still{0.0, 0.0};
    TrackMatrix J;
    const double step = 1e-6;
    for (int i = 0; i < kTrackStates; ++i) {
      TrackState up = state, down = state;
      up.mean(i) += step;
      down.mean(i) -= step;
      constantTurn().predict(up, 0.1, still);
      constantTurn().predict(down, 0.1, still);
      J.col(i) = (up.mean - down.mean) / (2.0 * step);
    }
    TrackState predicted = state;
    constantTurn().predict(predicted, 0.1, still);
    const TrackMatrix expected = J * J.transpose();
    const TrackMatrix error = predicted.covariance - expected;
    const double largest = error.topLeftCorner(5, 5).cwiseAbs().maxCoeff();
    EXPECT_LT(largest, 1e-5) << "turn rate " << w;
  }
}

TEST(MotionModels, WhatStandsStaysAndWhatMovesMovesOn) {
  TrackState stands = born(1.0, 2.0), drives = stands;
  stands.mean(kVx) = drives.mean(kVx) = 5.0;
  standing().predict(stands, 0.2, {});
  constantVelocity().predict(drives, 0.2, {});
  EXPECT_NEAR(stands.mean(kPx), 1.0, 1e-12);
  EXPECT_EQ(stands.mean(kVx), 0.0);
  EXPECT_NEAR(drives.mean(kPx), 2.0, 1e-12);
  EXPECT_NEAR(drives.covariance(kPx, kPx), 0.04 + 0.04 * 100.0 + 1.5 * 1.5 * 0.008 / 3.0, 1e-9);
}

}  // namespace
}  // namespace atlas
