// SPDX-License-Identifier: MIT
#include "atlas/lidar/ground.hpp"

#include <gtest/gtest.h>

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
