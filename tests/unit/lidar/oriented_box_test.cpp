// SPDX-License-Identifier: MIT
#include "atlas/lidar/oriented_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace atlas {
namespace {

const Eigen::Vector3d kEye(0.0, 0.0, 0.0);

std::vector<std::uint32_t> all(const std::vector<LidarPoint>& points) {
  std::vector<std::uint32_t> members(points.size());
  std::iota(members.begin(), members.end(), 0U);
  return members;
}

/// Local (along, across, up) about a centre, turned by yaw.
LidarPoint placed(double along, double across, double up, double yaw, const Eigen::Vector3d& center) {
  LidarPoint p;
  p.x = static_cast<float>(center.x() + std::cos(yaw) * along - std::sin(yaw) * across);
  p.y = static_cast<float>(center.y() + std::sin(yaw) * along + std::cos(yaw) * across);
  p.z = static_cast<float>(center.z() + up);
  return p;
}

/// Two sides of a car of 4.2 x 1.8 x 1.4 m as a lidar sees them, with noise.
std::vector<LidarPoint> twoSides(double yaw, const Eigen::Vector3d& center, double noise_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, noise_m > 0 ? noise_m : 1.0);
  const auto n = [&] { return noise_m > 0 ? noise(random) : 0.0; };
  std::vector<LidarPoint> points;
  for (double z = -0.7; z <= 0.7001; z += 0.2) {
    for (double s = -2.1; s <= 2.1001; s += 0.1) points.push_back(placed(s, -0.9 + n(), z, yaw, center));
    for (double s = -0.9; s <= 0.9001; s += 0.1) points.push_back(placed(-2.1 + n(), s, z, yaw, center));
  }
  return points;
}

double angleBetweenBoxes(double a, double b) { return std::abs(std::remainder(a - b, M_PI)); }

TEST(OrientedBox, TwoSidesGiveTheWholeCarAtAnyYaw) {
  const Eigen::Vector3d center(1234.0, -567.0, 12.0);
  for (int yaw_deg = -88; yaw_deg <= 90; yaw_deg += 7) {
    const double yaw = yaw_deg * M_PI / 180.0;
    const auto points = twoSides(yaw, center, 0.02, 1);
    const LidarPoint eye = placed(-12.0, -9.0, 1.0, yaw, center);  // it sees both sides
    const Outcome<Obstacle> box = fitBox(points, all(points), {eye.x, eye.y, eye.z});
    ASSERT_TRUE(box);
    EXPECT_LT(angleBetweenBoxes(box->yaw_rad, yaw), 1.5 * M_PI / 180.0) << yaw_deg;
    EXPECT_NEAR(box->size.x(), 4.2, 0.15) << yaw_deg;
    EXPECT_NEAR(box->size.y(), 1.8, 0.2) << yaw_deg;
    EXPECT_NEAR(box->size.z(), 1.4, 0.01);
    EXPECT_LT((box->center - center).norm(), 0.15) << yaw_deg;
    EXPECT_GT(box->yaw_rad, -M_PI / 2);
    EXPECT_LE(box->yaw_rad, M_PI / 2);
  }
}

// W21: the published program's boxes began with the fourth point; the first three could lie outside.
TEST(OrientedBox, W21_EveryPointIsInsideItsBox) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> coordinate(-3.0, 3.0);
  for (int run = 0; run < 50; ++run) {
    std::vector<LidarPoint> points;
    for (int i = 0; i < 3; ++i)
      points.push_back(placed(4.0 + i, -4.0 - i, 5.0 + i, 0.1 * run, {100, 200, 3}));  // extreme
    for (int i = 0; i < 40; ++i) {
      points.push_back(
          placed(coordinate(random), coordinate(random) / 2, coordinate(random), 0.1 * run, {100, 200, 3}));
    }
    const Obstacle box = *fitBox(points, all(points), kEye);
    EXPECT_EQ(box.points, 43U);
    for (const LidarPoint& p : points) {
      const Eigen::Vector3d d = Eigen::Vector3d(p.x, p.y, p.z) - box.center;
      const double along = std::cos(box.yaw_rad) * d.x() + std::sin(box.yaw_rad) * d.y();
      const double across = -std::sin(box.yaw_rad) * d.x() + std::cos(box.yaw_rad) * d.y();
      EXPECT_LE(std::abs(along), box.size.x() / 2 + 1e-9);
      EXPECT_LE(std::abs(across), box.size.y() / 2 + 1e-9);
      EXPECT_LE(std::abs(d.z()), box.size.z() / 2 + 1e-9);
    }
    EXPECT_GE(box.size.x(), box.size.y());
  }
}

TEST(OrientedBox, WhatIsSeenBehindTheOutlineDoesNotTurnIt) {
  // many returns from a seat in the far corner, where the sides are hidden
  const Eigen::Vector3d center(14.0, 9.0, 0.0);
  for (int yaw_deg = -80; yaw_deg <= 90; yaw_deg += 34) {
    const double yaw = yaw_deg * M_PI / 180.0;
    auto points = twoSides(yaw, center, 0.02, 3);
    for (double along = 1.2; along <= 1.8; along += 0.01) {
      for (double across = 0.2; across <= 0.7; across += 0.01) {
        if (across < 0.2 + 0.8 * (along - 1.2)) points.push_back(placed(along, across, 0.4, yaw, center));
      }
    }
    const LidarPoint eye = placed(-12.0, -9.0, 1.0, yaw, center);
    const Obstacle box = *fitBox(points, all(points), {eye.x, eye.y, eye.z});
    EXPECT_LT(angleBetweenBoxes(box.yaw_rad, yaw), 2.0 * M_PI / 180.0) << yaw_deg;
  }
}

TEST(OrientedBox, LargeClustersKeepTheirExtremes) {
  // more points than are scored: the box still holds every one
  auto points = twoSides(0.5, {0, 0, 0}, 0.0, 1);
  while (points.size() < 5000) points.push_back(points[points.size() % 400]);
  points.push_back(placed(2.5, -0.9, 0.0, 0.5, {0, 0, 0}));  // at an index that the stride leaves out
  const Obstacle box = *fitBox(points, all(points), kEye);
  EXPECT_NEAR(box.size.x(), 4.6, 0.05);
}

TEST(OrientedBox, Edges) {
  EXPECT_EQ(fitBox({}, {}, kEye).reason(), Reason::kEmpty);
  const std::vector<LidarPoint> one = {placed(0, 0, 0, 0, {7, 8, 9})};
  const Obstacle box = *fitBox(one, {0}, kEye);
  EXPECT_LT((box.center - Eigen::Vector3d(7, 8, 9)).norm(), 1e-9);
  EXPECT_EQ(box.size, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace atlas
