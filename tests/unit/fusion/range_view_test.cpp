// SPDX-License-Identifier: MIT
#include "atlas/fusion/range_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tracking_scene.hpp"

namespace atlas {
namespace {

/// A wall all round at 30 m and a board of 6 m x 3 m at x = 8 m, seen from 1.8 m above the ground at the
/// origin.
BatchedSweep sweepWithBoard(bool with_board) {
  auto sweep = std::make_shared<Sweep>();
  for (double azimuth = -M_PI; azimuth < M_PI; azimuth += 0.005) {
    for (double elevation = -0.25; elevation < 0.15; elevation += 0.02) {
      const double x_at_board = 8.0, y = x_at_board * std::tan(azimuth),
                   z = x_at_board / std::cos(azimuth) * std::tan(elevation);
      const bool board = with_board && std::cos(azimuth) > 0.5 && std::abs(y) < 3.0 && z < 1.2;
      const double range = board ? x_at_board / std::cos(azimuth) : 30.0;
      LidarPoint p;
      p.x = static_cast<float>(range * std::cos(azimuth));
      p.y = static_cast<float>(range * std::sin(azimuth));
      p.z = static_cast<float>(range * std::tan(elevation));
      sweep->points.push_back(p);
    }
  }
  sweep->points.push_back({std::nanf(""), 0.0F, 0.0F, 0.0F, 0.0F, 0, 0});
  BatchedSweep batched;
  batched.stamp = at(0.0);
  batched.sweep = sweep;
  batched.T_map_lidar.translation = {0.0, 0.0, 1.8};
  batched.batches.push_back(
      {0, static_cast<std::uint32_t>(sweep->points.size()), at(0.0), batched.T_map_lidar});
  return batched;
}
TrackShape carAt(double x, double y) {
  TrackShape shape;
  shape.state.mean << x, y, 0.0, 0.0, 0.0, 4.4, 1.8;
  shape.middle_z_m.value = 0.9;
  shape.height_m.value = 1.6;
  return shape;
}

TEST(RangeView, TellsHiddenFromGone) {
  const RangeView open(sweepWithBoard(false)), board(sweepWithBoard(true));
  const auto free = open.census(carAt(15.0, 0.0)), hidden = board.census(carAt(15.0, 0.0));
  EXPECT_GT(free.through, 5);
  EXPECT_EQ(free.hidden + free.there, 0);
  EXPECT_GT(hidden.hidden, 5);
  EXPECT_EQ(hidden.through + hidden.there, 0);
  const auto there = board.census(carAt(8.0 + 2.2, 0.0));
  EXPECT_GT(there.there, there.through + there.hidden);
  const auto beside = board.census(carAt(0.0, 15.0));
  EXPECT_GT(beside.through, 5);
  EXPECT_EQ(beside.hidden, 0);
}

TEST(RangeView, ABoxIsCutWhereSomethingNearerBegins) {
  const RangeView board(sweepWithBoard(true));
  // seen from the origin, the board reaches to y = 5.6 m at 15 m; to its left the rest of a car comes out
  const RangeView::Sides left_of = board.hiddenSides({{15.0, 7.0, 0.9}, 0.5 * M_PI, {2.4, 0.4, 1.6}, 30});
  EXPECT_TRUE(left_of.right);
  EXPECT_FALSE(left_of.left);
  const RangeView::Sides before = board.hiddenSides({{6.0, 0.0, 0.9}, 0.0, {1.0, 1.0, 1.6}, 30});
  EXPECT_FALSE(before.left || before.right);
}

TEST(RangeView, NothingIsKnownWithoutAPose) {
  BatchedSweep batched = sweepWithBoard(true);
  batched.batches.clear();
  const RangeView view(batched);
  EXPECT_TRUE(view.empty());
  const auto census = view.census(carAt(15.0, 0.0));
  EXPECT_EQ(census.through + census.there + census.hidden + census.nothing, 0);
  TrackShape lost = carAt(15.0, 0.0);
  lost.state.mean(kPx) = std::nan("");
  const auto nowhere = RangeView(sweepWithBoard(true)).census(lost);
  EXPECT_EQ(nowhere.through + nowhere.there + nowhere.hidden, 0);
}

}  // namespace
}  // namespace atlas
