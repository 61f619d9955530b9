// SPDX-License-Identifier: MIT
#include "atlas/camera/frustum_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace atlas::test {
namespace {

/// A plate of 1 m x 1 m at `place`, its box 100 px to a metre.
Frustum plate(const Eigen::Vector3d& place, std::int32_t class_id = 2, double confidence = 0.8) {
  Frustum f;
  f.position = place;
  f.distance_m = place.x();
  f.points = 10;
  f.detection.class_id = class_id;
  f.detection.confidence = confidence;
  f.detection.x_min = -100.0 * place.y() - 50.0;
  f.detection.x_max = -100.0 * place.y() + 50.0;
  f.detection.y_max = 100.0;
  for (std::size_t i = 0; i < 8; ++i) f.corners[i] = place + Eigen::Vector3d(0, 0, static_cast<double>(i));
  return f;
}
Frustums image(int milliseconds, std::vector<Frustum> frustums) {
  Frustums result;
  result.stamp = milliseconds * kMillisecond;
  result.frustums = std::move(frustums);
  return result;
}

// 20 m/s to the left, seen every 0.1 s; and the same with images that are not evenly spaced.
TEST(FrustumMotion, velocityByHand) {
  for (const int last : {200, 240}) {
    const Frustums before = image(0, {plate({20, 0, 0})}), now = image(100, {plate({20, 2, 0})}),
                   after = image(last, {plate({20, 0.02 * last, 0})});
    for (const auto& [a, b] : {std::pair{&before, &after}, {&before, nullptr}, {nullptr, &after}}) {
      const auto objects = followObjects(a, now, b, {});
      ASSERT_EQ(objects.size(), 1U);
      EXPECT_EQ(objects[0].index, 0U);
      EXPECT_NEAR((objects[0].velocity_map_mps - Eigen::Vector3d(0, 20, 0)).norm(), 0.0, 1e-9);
      const Frustum later = moved(objects[0], 0.03);
      EXPECT_NEAR(later.position.y(), 2.6, 1e-9);
      EXPECT_NEAR(later.corners[7].y(), 2.6, 1e-9);
      EXPECT_NEAR(moved(objects[0], -0.03).corners[0].y(), 1.4, 1e-9);
    }
  }
}

TEST(FrustumMotion, noNeighbourNoVelocity) {
  const auto objects = followObjects(nullptr, image(100, {plate({20, 1, 0})}), nullptr, {});
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].velocity_map_mps, Eigen::Vector3d::Zero());
}

// Half a metre to and fro is the noise of boxes and distances.
TEST(FrustumMotion, aShortWayIsNoMotion) {
  const Frustums before = image(0, {plate({20, 0, 0})}), now = image(100, {plate({20.2, 0, 0})}),
                 after = image(200, {plate({20.5, 0, 0})});
  EXPECT_EQ(followObjects(&before, now, &after, {}).at(0).velocity_map_mps, Eigen::Vector3d::Zero());
}

// The distance jumps by 2 m in one image: that is not a speed of 20 m/s there and back.
TEST(FrustumMotion, aJumpOfTheDistanceIsNoSpeed) {
  const Frustums before = image(0, {plate({20, 0, 0})}), now = image(100, {plate({22, 0, 0})}),
                 after = image(200, {plate({21.5, 0, 0})});
  EXPECT_EQ(followObjects(&before, now, &after, {}).at(0).velocity_map_mps, Eigen::Vector3d::Zero());
  const Frustums far_away = image(0, {plate({25.5, 0, 0})});  // 55 m/s
  EXPECT_EQ(followObjects(&far_away, image(100, {plate({20, 0, 0})}), nullptr, {}).at(0).velocity_map_mps,
            Eigen::Vector3d::Zero());
}

// Two people beside each other, one is missed: the other is not taken for both.
TEST(FrustumMotion, aMissedObjectIsBridged) {
  const Frustums before = image(0, {plate({20, 0, 0}, 0), plate({20, 2, 0}, 0, 0.6)}),
                 now = image(100, {plate({20, 0.1, 0}, 0)}),
                 after = image(300, {plate({20, 2.6, 0.3}, 0), plate({20, 0.3, 0}, 0)});
  const auto objects = followObjects(&before, now, &after, {});
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].index, 0U);
  EXPECT_EQ(objects[1].index, kBridged);
  const Frustum& missed = objects[1].frustum;  // a third of the way
  EXPECT_NEAR((missed.position - Eigen::Vector3d(20, 2.2, 0.1)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((missed.corners[3] - Eigen::Vector3d(20, 2.2, 3.1)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(missed.detection.x_min, -270.0, 1e-9);
  EXPECT_NEAR(missed.detection.confidence, 0.3, 1e-9) << "half of the less certain neighbour's";
  EXPECT_NEAR((objects[1].velocity_map_mps - Eigen::Vector3d(0, 2, 1)).norm(), 0.0, 1e-9);
}

TEST(FrustumMotion, onlyWhatBothNeighboursHaveIsBridged) {
  const Frustums has = image(0, {plate({20, 0, 0})}), has_later = image(200, {plate({20, 0, 0})}),
                 other_class = image(200, {plate({20, 0, 0}, 7)}),
                 elsewhere = image(200, {plate({40, 0, 0})}), nothing = image(100, {});
  EXPECT_EQ(followObjects(&has, nothing, &has_later, {}).size(), 1U);
  EXPECT_TRUE(followObjects(&has, nothing, nullptr, {}).empty());
  EXPECT_TRUE(followObjects(nullptr, nothing, &has_later, {}).empty());
  EXPECT_TRUE(followObjects(&has, nothing, &other_class, {}).empty());
  EXPECT_TRUE(followObjects(&has, nothing, &elsewhere, {}).empty());
}

// Its distance is wrong, so it is not known again by its place; its box says that it is there.
TEST(FrustumMotion, anObjectWithAWrongDistanceIsNotBridged) {
  Frustum wrong = plate({20, 0, 0});
  wrong.position.x() = 60.0;
  const Frustums before = image(0, {plate({20, 0, 0})}), now = image(100, {wrong}),
                 after = image(200, {plate({20, 0, 0})});
  const auto objects = followObjects(&before, now, &after, {});
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].index, 0U);
}

TEST(FrustumMotion, refusesBadParameters) {
  FrustumMotionParams params;
  params.bridged_confidence = 1.5;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.largest_speed_mps = std::nan("");
  EXPECT_THROW(validate(params), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
