// SPDX-License-Identifier: MIT
#include "atlas/lidar/ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace atlas {
namespace {

using Height = std::function<double(double, double)>;

/// Points every 0.4 m with 2 cm noise (a lidar's), none nearer than 3 m to the vehicle at (cx, cy).
std::vector<LidarPoint> surface(const Height& height, double cx, double cy, double radius_m = 30.0) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::vector<LidarPoint> points;
  for (double x = -radius_m; x <= radius_m; x += 0.4) {
    for (double y = -radius_m; y <= radius_m; y += 0.4) {
      const double range = std::hypot(x, y);
      if (range < 3.0 || range > radius_m) continue;
      LidarPoint p;
      p.x = static_cast<float>(cx + x);
      p.y = static_cast<float>(cy + y);
      p.z = static_cast<float>(height(cx + x, cy + y) + noise(random));
      points.push_back(p);
    }
  }
  return points;
}

GroundParams params() {
  GroundParams p;
  p.radius_m = 30.0;
  return p;
}

double worst(const GroundGrid& grid, const Height& height, double cx, double cy, double radius_m = 28.0) {
  double result = 0.0;
  for (double x = -radius_m; x <= radius_m; x += 0.37) {
    for (double y = -radius_m; y <= radius_m; y += 0.37) {
      if (std::hypot(x, y) > radius_m || std::hypot(x, y) < 3.5) continue;
      result = std::max(result, std::abs(grid.heightAt(cx + x, cy + y) - height(cx + x, cy + y)));
    }
  }
  return result;
}

TEST(Ground, W20_W23_FlatAnywhereInMap) {
  // The published program cut at a constant z (W20), and found road only at the height of the start (W23).
  for (const double level : {0.0, -12.0, 230.0}) {
    const Height flat = [level](double, double) { return level; };
    const GroundGrid grid(surface(flat, 500, -300), {500, -300, level + 1.7}, params());
    EXPECT_LT(worst(grid, flat, 500, -300), 0.05);
  }
}

TEST(Ground, W20_SlopesAreGround) {
  for (const double slope : {0.05, 0.12, 0.2}) {
    const Height hill = [slope](double x, double y) { return slope * x - 0.5 * slope * y; };
    const GroundGrid grid(surface(hill, 0, 0), {0, 0, 1.7}, params());
    EXPECT_LT(worst(grid, hill, 0, 0), 0.12) << slope;  // half the tolerance of the classification
  }
}

TEST(Ground, W20_KerbIsGround) {
  const Height street = [](double, double y) { return y > 4.0 ? 0.15 : 0.0; };
  const auto points = surface(street, 0, 0);
  const GroundGrid grid(points, {0, 0, 1.7}, params());
  for (const LidarPoint& p : points) {
    EXPECT_LT(std::abs(static_cast<double>(p.z) - grid.heightAt(p.x, p.y)), 0.25) << p.x << " " << p.y;
  }
}

TEST(Ground, SpeedBumpsAreGround) {
  // a round one of 0.1 x 0.9 m and a plateau of 0.12 m with ramps of 1:8 across the whole street
  const Height bump = [](double x, double) {
    const double s = (x - 8.0) / 0.45;
    return std::abs(s) < 1.0 ? 0.1 * (1.0 - s * s) : 0.0;
  };
  const Height plateau = [](double x, double) {
    return 0.12 * std::clamp((4.0 - std::abs(x - 12.0)) / 1.0, 0.0, 1.0);
  };
  for (const Height& height : {bump, plateau}) {
    const auto points = surface(height, 0, 0);
    const GroundGrid grid(points, {0, 0, 1.7}, params());
    for (const LidarPoint& p : points)
      ASSERT_LT(std::abs(static_cast<double>(p.z) - grid.heightAt(p.x, p.y)), 0.2) << p.x << " " << p.y;
  }
}

TEST(Ground, HillsThatBeginAndEndAreGround) {
  // level, then 12 % up, then level again, each over 8 m and more
  const Height hill = [](double x, double) { return 0.12 * std::clamp(x - 6.0, 0.0, 10.0); };
  const auto points = surface(hill, 0, 0);
  const GroundGrid grid(points, {0, 0, 1.7}, params());
  EXPECT_LT(worst(grid, hill, 0, 0), 0.2);
}

TEST(Ground, TheSillOfACarIsNotTheRoad) {
  // nothing but the side of a bus from 0.35 m upwards is seen where it stands, also not the road behind it
  const Height uphill = [](double x, double) { return 0.05 * x; };
  auto points = surface(uphill, 0, 0);
  const auto hidden = [](const LidarPoint& p) {
    return p.x > 2.0F && p.x < 14.0F && p.y > 4.0F && p.y < 7.0F;
  };
  points.erase(std::remove_if(points.begin(), points.end(), hidden), points.end());
  for (double x = 2.0; x < 14.0; x += 0.1) {
    for (double up = 0.35; up < 3.0; up += 0.2) {
      LidarPoint p;
      p.x = static_cast<float>(x);
      p.y = 4.5F;
      p.z = static_cast<float>(uphill(x, 4.5) + up);
      points.push_back(p);
    }
  }
  const GroundGrid grid(points, {0, 0, 1.7}, params());
  for (double x = 2.5; x < 13.5; x += 0.5) EXPECT_NEAR(grid.heightAt(x, 4.5), uphill(x, 4.5), 0.1) << x;
}

TEST(Ground, TwoLidarsFillOneGrid) {
  // each sees one half of a street with a kerb; the grid of both is as good as that of one that sees all
  const Height street = [](double x, double y) { return 0.05 * x + (y > 4.0 ? 0.12 : 0.0); };
  const auto all = surface(street, 0, 0);
  std::vector<LidarPoint> left, both;
  for (const LidarPoint& p : all) {
    if (p.y > 0.0F) left.push_back(p);
  }
  both = left;
  for (const LidarPoint& p : all) {
    if (p.y <= 0.0F) both.push_back(p);
  }
  const GroundGrid one(left, {0, 0, 1.7}, params()), two(both, {0, 0, 1.7}, params());
  EXPECT_LT(worst(two, street, 0, 0), 0.2);
  EXPECT_LT(one.believedCells(), two.believedCells() * 6 / 10);
  const GroundGrid together(all, {0, 0, 1.7}, params());
  for (double x = -25.0; x < 25.0; x += 1.3)
    EXPECT_EQ(two.heightAt(x, 0.3 * x), together.heightAt(x, 0.3 * x))
        << "the order of points has no influence";
}

TEST(Ground, RoofsAndWallsDoNotLiftIt) {
  // a truck's box of 8 x 2.5 m whose roof is all that is seen of it, and a wall along the street
  const Height flat = [](double, double) { return 0.0; };
  auto points = surface(flat, 0, 0);
  for (LidarPoint& p : points) {
    if (p.x > 6 && p.x < 14 && p.y > -1.25F && p.y < 1.25F) p.z += 1.4F;
    if (p.y > 10.0F) p.z += 3.0F;
  }
  const GroundGrid grid(points, {0, 0, 1.7}, params());
  for (double x = 6.5; x < 13.5; x += 0.5) EXPECT_LT(std::abs(grid.heightAt(x, 0.0)), 0.15) << x;
  for (double x = -20; x < 20; x += 1.0) EXPECT_LT(std::abs(grid.heightAt(x, 10.5)), 0.3) << x;
}

TEST(Ground, ADeepReflectionDoesNotPullItDown) {
  const Height flat = [](double, double) { return 0.0; };
  auto points = surface(flat, 0, 0);
  for (const double x : {5.5, 8.5, 12.5}) {
    LidarPoint p = points.front();
    p.x = static_cast<float>(x);
    p.y = 0.5F;
    p.z = -4.0F;
    points.push_back(p);
  }
  const GroundGrid grid(points, {0, 0, 1.7}, params());
  EXPECT_LT(worst(grid, flat, 0, 0), 0.06);
}

TEST(Ground, AQuayKeepsItsHeightAboveTheRiver) {
  const Height quay = [](double, double y) { return y > 6.0 ? -5.0 : 0.0; };
  const auto points = surface(quay, 0, 0);
  const GroundGrid grid(points, {0, 0, 1.7}, params());
  for (double x = -20; x < 20; x += 1.0) EXPECT_LT(std::abs(grid.heightAt(x, 5.0)), 0.1) << x;
}

TEST(Ground, UnknownWithoutPoints) {
  const GroundGrid grid({}, {0, 0, 0}, params());
  EXPECT_TRUE(std::isnan(grid.heightAt(1, 1)));
  EXPECT_EQ(grid.believedCells(), 0U);
  const Height flat = [](double, double) { return 0.0; };
  const GroundGrid some(surface(flat, 0, 0), {0, 0, 1.7}, params());
  EXPECT_TRUE(std::isnan(some.heightAt(100, 0))) << "outside the grid";
}

}  // namespace
}  // namespace atlas
