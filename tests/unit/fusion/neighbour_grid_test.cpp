// SPDX-License-Identifier: MIT
#include "atlas/fusion/neighbour_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace atlas {
namespace {

TEST(NeighbourGrid, FindsTheSameAsLookingAtAll) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-30.0, 30.0);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 400; ++i) points.emplace_back(at(random), at(random));
  const NeighbourGrid grid(points, 5.0);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector2d place(at(random), at(random));
    std::vector<std::pair<double, std::uint32_t>> all;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const double distance = (points[i] - place).norm();
      if (distance <= 8.0) all.emplace_back(distance, i);
    }
    std::sort(all.begin(), all.end());
    if (all.size() > 10) all.resize(10);
    std::vector<std::uint32_t> expected;
    for (const auto& [distance, i] : all) expected.push_back(i);
    EXPECT_EQ(grid.nearest(place, 8.0, 10), expected);
  }
}

TEST(NeighbourGrid, FarPlacesAndNone) {
  const std::vector<Eigen::Vector2d> far = {{1e18, -1e18}, {0.0, 0.0}};
  EXPECT_EQ(NeighbourGrid(far, 5.0).nearest({0.5, 0.0}, 1.0, 5), (std::vector<std::uint32_t>{1}));
  const std::vector<Eigen::Vector2d> none;
  EXPECT_TRUE(NeighbourGrid(none, 5.0).nearest({0.0, 0.0}, 10.0, 5).empty());
}

}  // namespace
}  // namespace atlas
