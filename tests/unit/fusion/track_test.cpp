// SPDX-License-Identifier: MIT
#include "atlas/fusion/track.hpp"

#include <gtest/gtest.h>

#include "tracking_scene.hpp"

namespace atlas {
namespace {

Track trackOf(const Measurement& measurement) {
  return {1, at(0.0), *measurement.birth(), std::make_shared<const MotionModels>(motionModels()),
          std::make_shared<const ClassModel>(ClassParams{})};
}
WholeBox carAt(double x, double yaw) { return {{{x, 0.0, 0.8}, yaw, {4.4, 1.8, 1.5}, 100}, {}}; }

TEST(Track, ExistenceByHand) {
  const WholeBox box = carAt(10.0, 0.0);
  Track track = trackOf(box);
  EXPECT_DOUBLE_EQ(track.existence(), 0.3);
  track.witness(box, "detections");  // odds 3/7 times 4
  EXPECT_NEAR(track.existence(), 12.0 / 19.0, 1e-12);
  track.miss(0.5);  // r (1 - d) / (1 - r d)
  EXPECT_NEAR(track.existence(), 0.5 * (12.0 / 19.0) / (1.0 - 0.5 * 12.0 / 19.0), 1e-12);
  const double before = track.existence();
  track.miss(0.0);
  EXPECT_EQ(track.existence(), before) << "a scan that would not have shown it says nothing";
}

TEST(Track, HistoryIsBoundedAndInOrder) {
  Track track = trackOf(carAt(0.0, 0.0));
  for (int i = 1; i <= 10; ++i) {
    track.predict(at(0.1 * i));
    track.remember(4);
  }
  const Object object = track.report(0.5);
  ASSERT_EQ(object.history.size(), 4U);
  EXPECT_EQ(object.history.front().stamp, at(0.7));
  EXPECT_EQ(object.history.back().stamp, at(1.0));
  EXPECT_NEAR(object.age_s, 1.0, 1e-9);
}

TEST(Track, APoleIsNoCarWhateverTheCameraSays) {
  const Obstacle pole{{10.0, 0.0, 1.7}, 0.0, {0.3, 0.3, 3.4}, 100};
  const SeenBox seen(pole, {0.0, 0.0, 1.8}, {});
  Track track = trackOf(seen);
  const FrustumMeasurement car(frustumOf({10.0, 0.0, 0.8}, {0.0, 0.0, 1.5}, 1.8, 1.5, 2));
  for (int i = 1; i <= 10; ++i) {
    track.predict(at(0.1 * i));
    track.update(seen, 2.5);
    track.witness(car, "frustums");
  }
  EXPECT_EQ(track.report(0.5).class_id, -1);
}

}  // namespace
}  // namespace atlas
