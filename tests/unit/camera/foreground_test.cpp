// SPDX-License-Identifier: MIT
#include "atlas/camera/foreground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace atlas::test {
namespace {

Detection2d box100() { return {0.0, 0.0, 100.0, 100.0, 2, 0.9}; }

/// A grid of points over a part of the box, 2 px apart.
void fill(std::vector<BoxPoint>& points, float u1, float v1, float u2, float v2, float depth,
          float time = 0.0F) {
  for (float u = u1; u < u2; u += 2.0F) {
    for (float v = v1; v < v2; v += 2.0F) points.push_back({u, v, depth, time});
  }
}

// The object covers the middle third, the wall behind it the rest: more than half of the points.
TEST(Foreground, objectInFrontOfAWallThatFillsMostOfTheBox) {
  std::vector<BoxPoint> points;
  fill(points, 0, 0, 30, 100, 30.0F);
  fill(points, 70, 0, 100, 100, 30.0F);
  fill(points, 30, 0, 70, 100, 12.0F);
  const auto found = findForeground(box100(), points, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->front_m, 12.0, 1e-5);
  EXPECT_NEAR(found->back_m, 12.0, 1e-5);
  EXPECT_EQ(found->points, 1000U);
}

// Something nearer covers a corner, and the road runs through below: neither is in the middle.
TEST(Foreground, neitherTheRoadNorWhatCoversACorner) {
  std::vector<BoxPoint> points;
  fill(points, 0, 30, 35, 100, 5.0F);
  fill(points, 35, 10, 100, 80, 12.0F);
  for (int row = 0; row < 10; ++row) {
    const float v = 80.0F + 2.0F * static_cast<float>(row);
    fill(points, 35, v, 100, v + 2.0F, 20.0F - static_cast<float>(row));
  }
  const auto found = findForeground(box100(), points, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->front_m, 12.0, 1e-5);
}

// The side of a car from 10 m to 14.5 m: its front is where it begins, its extent how far it goes.
TEST(Foreground, extentIsThatOfTheSurface) {
  std::vector<BoxPoint> points;
  for (int i = 0; i < 50; ++i) {
    const float u = 2.0F * static_cast<float>(i);
    fill(points, u, 16, u + 2.0F, 100, 10.0F + 0.09F * static_cast<float>(i));
  }
  fill(points, 0, 0, 100, 16, 40.0F);
  const auto found = findForeground(box100(), points, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->front_m, 10.0, 0.2);
  EXPECT_NEAR(found->back_m, 14.5, 0.3);
}

// A car drives away at 10 m/s: the older points are up to 5 m nearer.
TEST(Foreground, whatMovesIsWhereItIsNow) {
  std::vector<BoxPoint> points;
  for (int i = -5; i <= 0; ++i)
    fill(points, 20, 20, 80, 80, 20.0F + static_cast<float>(i), 0.1F * static_cast<float>(i));
  EXPECT_NEAR(findForeground(box100(), points, {})->front_m, 20.0, 1e-5);
  // Too few recent points: all of them are used.
  std::vector<BoxPoint> few;
  fill(few, 20, 20, 80, 80, 18.0F, -0.3F);
  few.push_back({50, 50, 18.0F, 0.0F});
  EXPECT_EQ(findForeground(box100(), few, {})->points, 901U);
}

TEST(Foreground, orderOfThePointsHasNoInfluence) {
  std::vector<BoxPoint> points;
  std::mt19937 random(5);
  std::normal_distribution<float> noise(15.0F, 0.02F);
  for (int i = 0; i < 300; ++i)
    points.push_back({static_cast<float>(i % 20) * 5.0F, static_cast<float>(i / 20) * 6.0F,
                      i % 3 == 0 ? 40.0F : noise(random), 0.0F});
  auto first = points;
  const Foreground expected = findForeground(box100(), first, {}).value();
  for (int i = 0; i < 20; ++i) {
    std::shuffle(points.begin(), points.end(), random);
    auto copy = points;
    const Foreground found = findForeground(box100(), copy, {}).value();
    EXPECT_EQ(found.front_m, expected.front_m);
    EXPECT_EQ(found.back_m, expected.back_m);
    EXPECT_EQ(found.sigma_m, expected.sigma_m);
  }
}

// sigma is the scatter of repeated measurements, here of a surface 0.6 m deep.
TEST(Foreground, sigmaIsTheScatterOfTheFront) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> depth(20.0F, 20.6F), place(0.0F, 100.0F);
  double sum = 0, sum_sq = 0, sigma = 0;
  constexpr int kRuns = 1000;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<BoxPoint> points;
    for (int i = 0; i < 60; ++i) points.push_back({place(random), place(random), depth(random), 0.0F});
    const Foreground found = findForeground(box100(), points, {}).value();
    sum += found.front_m;
    sum_sq += found.front_m * found.front_m;
    sigma += found.sigma_m;
  }
  const double mean = sum / kRuns, scatter = std::sqrt(sum_sq / kRuns - mean * mean);
  EXPECT_NEAR(sigma / kRuns, std::sqrt(scatter * scatter + 0.02 * 0.02), 0.3 * scatter + 0.01);
}

TEST(Foreground, tooFewPoints) {
  std::vector<BoxPoint> none;
  EXPECT_EQ(findForeground(box100(), none, {}).reason(), Reason::kNoPoints);
  std::vector<BoxPoint> two = {{50, 50, 10, 0}, {50, 52, 10, 0}};
  EXPECT_EQ(findForeground(box100(), two, {}).reason(), Reason::kLowQuality);
}

}  // namespace
}  // namespace atlas::test
