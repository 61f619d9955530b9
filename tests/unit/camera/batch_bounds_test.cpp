// SPDX-License-Identifier: MIT
#include "atlas/camera/batch_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace atlas {
namespace {

TEST(BatchBounds, byHand) {
  BatchBounds bounds;
  EXPECT_TRUE(bounds.empty());
  EXPECT_TRUE(bounds.add({3, 4, 0}));
  EXPECT_TRUE(bounds.add({0, 10, 0}));
  EXPECT_FALSE(bounds.add({std::nanf(""), 1, 0})) << "no return";
  EXPECT_FALSE(bounds.add({0, 0, 0})) << "neither";
  EXPECT_FALSE(bounds.add({std::numeric_limits<float>::infinity(), 0, 0}));
  ASSERT_FALSE(bounds.empty());
  EXPECT_EQ(bounds.min_range_m, 5.0F);
  EXPECT_EQ(bounds.max_range_m, 10.0F);
  EXPECT_TRUE(bounds.low_direction.isApprox(Eigen::Vector3f(0.0F, 0.8F, 0.0F)));
  EXPECT_TRUE(bounds.high_direction.isApprox(Eigen::Vector3f(0.6F, 1.0F, 0.0F)));
  // y - 20: the best is 10 * 1 - 20; -y + 1: the best is 5 * -0.8 + 1
  EXPECT_FLOAT_EQ(bounds.largest({0, 1, 0}, -20.0F), -10.0F);
  EXPECT_FLOAT_EQ(bounds.largest({0, -1, 0}, 1.0F), -3.0F);
}

TEST(BatchBounds, nothingInsideExceedsTheLargest) {
  std::mt19937 random(5);
  std::normal_distribution<float> n;
  for (int run = 0; run < 200; ++run) {
    const Eigen::Vector3f middle = 20.0F * Eigen::Vector3f(n(random), n(random), n(random));
    std::vector<Eigen::Vector3f> points;
    BatchBounds bounds;
    for (int i = 0; i < 30; ++i) {
      points.push_back(middle + 3.0F * Eigen::Vector3f(n(random), n(random), n(random)));
      bounds.add(points.back());
    }
    const Eigen::Vector3f normal(n(random), n(random), n(random));
    for (const Eigen::Vector3f& p : points)
      EXPECT_LE(normal.dot(p) + 1.5F, bounds.largest(normal, 1.5F) + 1e-3F);
  }
}

}  // namespace
}  // namespace atlas
