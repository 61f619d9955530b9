// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "atlas/fusion/track.hpp"
#include "tracking_scene.hpp"

namespace atlas {
namespace {

Track trackOf(const WholeBox& measurement) {
  return {1, at(0.0), *measurement.birth(), std::make_shared<const MotionModels>(motionModels()),
          std::make_shared<const ClassModel>(ClassParams{})};
}
WholeBox carAt(double x, double yaw) { return {{{x, 0.0, 0.8}, yaw, {4.4, 1.8, 1.5}, 100}, {}}; }

TEST(TrackHeading, AHeadingThatADetectorTurnsRoundNowAndThenStays) {
  Track track = trackOf(carAt(0.0, 0.0));
  for (int i = 1; i <= 30; ++i) {
    track.predict(at(0.1 * i));
    track.update(carAt(0.8 * i, i % 4 == 0 ? M_PI : 0.0), 2.5);
  }
  EXPECT_NEAR(track.shape().yaw_rad, 0.0, 0.1);
  EXPECT_TRUE(track.report(0.5).heading_known);
}

TEST(TrackHeading, AHeadingThatWasTakenTheWrongWayRoundIsTurnedByTheMotion) {
  Track track = trackOf(carAt(0.0, M_PI));
  for (int i = 1; i <= 40; ++i) {
    track.predict(at(0.1 * i));
    Obstacle box{{0.8 * i, 0.0, 0.8}, 0.0, {4.4, 1.8, 1.5}, 100};
    track.update(SeenBox(box, {0.8 * i - 15.0, -10.0, 1.8}, {}), 2.5);
  }
  EXPECT_NEAR(track.shape().yaw_rad, 0.0, 0.1);
}

TEST(TrackHeading, ABoxWhoseLengthIsTheWidthOfTheTrackBeginsItsBoxAfresh) {
  // what was seen first, with a piece of something else, was wider than long
  Track track = trackOf(WholeBox{{{20.0, 0.0, 0.8}, 0.5 * M_PI, {3.5, 2.0, 1.0}, 100}, {}});
  for (int i = 1; i <= 5; ++i) {
    track.predict(at(0.1 * i));
    track.update(SeenBox{{{20.0, 0.0, 0.8}, 0.0, {4.4, 1.7, 1.2}, 100}, {10.0, -8.0, 1.8}, {}}, 2.5);
  }
  EXPECT_NEAR(std::remainder(track.shape().yaw_rad, M_PI), 0.0, 0.1);
  EXPECT_NEAR(track.shape().length(), 4.4, 0.3);
  EXPECT_NEAR(track.shape().width(), 1.7, 0.3);
}

}  // namespace
}  // namespace atlas
