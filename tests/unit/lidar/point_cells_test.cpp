// SPDX-License-Identifier: MIT
#include "atlas/lidar/point_cells.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

namespace atlas {
namespace {

std::set<std::uint32_t> neighbours(const PointCells& cells, const LidarPoint& center) {
  std::set<std::uint32_t> found;
  cells.around(center, [&](std::uint32_t i, const Eigen::Vector3d&) {
    EXPECT_TRUE(found.insert(i).second) << i << " twice";
  });
  return found;
}

TEST(PointCells, FindsWhatIsWithinTheRadius) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(-2.0F, 2.0F);  // cells on both sides of 0
  std::vector<LidarPoint> points(600);
  for (LidarPoint& p : points) p.x = place(random), p.y = place(random), p.z = place(random);
  points[7].y = std::numeric_limits<float>::quiet_NaN();
  const double radius_m = 0.7;
  const PointCells cells(points, radius_m);
  for (std::size_t i = 0; i < points.size(); i += 10) {
    std::set<std::uint32_t> expected;
    const Eigen::Vector3d middle(points[i].x, points[i].y, points[i].z);
    for (std::uint32_t k = 0; k < points.size(); ++k) {
      const Eigen::Vector3d p(points[k].x, points[k].y, points[k].z);
      if ((p - middle).squaredNorm() <= radius_m * radius_m) expected.insert(k);
    }
    EXPECT_EQ(neighbours(cells, points[i]), expected) << i;
  }
  EXPECT_TRUE(neighbours(cells, points[7]).empty());
}

TEST(PointCells, OffsetsPointFromTheCenter) {
  std::vector<LidarPoint> points(2);
  points[1].x = 0.25F;
  const PointCells cells(points, 1.0);
  cells.around(points[0], [](std::uint32_t i, const Eigen::Vector3d& offset) {
    EXPECT_EQ(offset, Eigen::Vector3d(i == 1 ? 0.25 : 0.0, 0, 0));
  });
  EXPECT_TRUE(neighbours(PointCells({}, 1.0), points[0]).empty());
}

}  // namespace
}  // namespace atlas
