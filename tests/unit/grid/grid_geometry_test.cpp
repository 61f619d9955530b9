// SPDX-License-Identifier: MIT
#include "atlas/grid/grid_geometry.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace atlas {
namespace {

TEST(GridGeometry, LiesAheadOfTheVehicleAndFollowsItByWholeCells) {
  GridParams params;
  params.ahead_m = 15.0;
  const GridGeometry at_origin = placeGrid(params, {0.0, 0.0}, 0.0);
  EXPECT_EQ(at_origin.columns, 200);
  EXPECT_EQ(at_origin.rows, 200);
  EXPECT_DOUBLE_EQ(at_origin.corner().x(), -5.0);
  EXPECT_DOUBLE_EQ(at_origin.corner().y(), -20.0);
  for (double x = -3.0; x < 3.0; x += 0.037) {
    const GridGeometry moved = placeGrid(params, {x, -x}, 0.0);
    EXPECT_NEAR(moved.corner().x() + 5.0, x, 0.5 * params.cell_m + 1e-9);
    EXPECT_DOUBLE_EQ(moved.corner().x(), static_cast<double>(moved.first_column) * params.cell_m);
  }
}

TEST(GridGeometry, APlaceKeepsItsCellOfTheMapWhateverTheVehicleDoes) {
  GridParams params;
  const Eigen::Vector2d place(7.31, -2.77);
  for (double yaw = -3.0; yaw < 3.0; yaw += 0.1) {
    const GridGeometry g = placeGrid(params, {0.7 * yaw, 0.3}, yaw);
    EXPECT_EQ(g.first_column + g.columnOf(place.x()), 36);  // floor(7.31 / 0.2)
    EXPECT_EQ(g.first_row + g.rowOf(place.y()), -14);       // floor(-2.77 / 0.2)
  }
}

TEST(GridGeometry, MiddleOfACellLiesInIt) {
  const GridGeometry g = placeGrid(GridParams{}, {1234.5, -987.6}, 1.0);
  for (const auto& [column, row] : {std::pair<int, int>{0, 0}, {199, 0}, {0, 199}, {77, 123}}) {
    const Eigen::Vector2d middle = g.middleOf(column, row);
    EXPECT_EQ(g.columnOf(middle.x()), column);
    EXPECT_EQ(g.rowOf(middle.y()), row);
    EXPECT_TRUE(g.contains(column, row));
  }
  EXPECT_FALSE(g.contains(-1, 0));
  EXPECT_FALSE(g.contains(0, 200));
}

TEST(GridGeometry, RefusesSizesThatMakeNoGrid) {
  GridParams params;
  params.cell_m = 0.0;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.length_m = 1e6;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.width_m = -1.0;
  EXPECT_THROW(validate(params), std::invalid_argument);
  EXPECT_NO_THROW(validate(GridParams{}));
}

}  // namespace
}  // namespace atlas
