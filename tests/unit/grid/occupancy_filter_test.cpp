// SPDX-License-Identifier: MIT
#include "atlas/grid/occupancy_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace atlas {
namespace {

constexpr int kSide = 64;  // no multiple of what is worked on at once

GridGeometry geometry(std::int64_t first_column = 0, std::int64_t first_row = 0) {
  GridGeometry g;
  g.columns = kSide;
  g.rows = kSide;
  g.first_column = first_column;
  g.first_row = first_row;
  return g;
}

/// All seen free but a box of the map, whose lower corner is (x, y) in cells.
std::vector<float> evidenceOf(const GridGeometry& g, double x, double y, int width, int height) {
  std::vector<float> occupied(g.cells(), 0.2F);
  for (int row = 0; row < g.rows; ++row) {
    for (int column = 0; column < g.columns; ++column) {
      const double at_x = static_cast<double>(g.first_column + column) + 0.5 - x,
                   at_y = static_cast<double>(g.first_row + row) + 0.5 - y;
      if (at_x >= 0.0 && at_x < width && at_y >= 0.0 && at_y < height)
        occupied[g.indexOf(column, row)] = 0.9F;
    }
  }
  return occupied;
}

class BothFilters : public ::testing::TestWithParam<FilterMode> {
 protected:
  [[nodiscard]] std::unique_ptr<OccupancyFilter> make() const {
    FilterParams params;
    params.mode = GetParam();
    return makeFilter(params);
  }
  RowWorkers one_{1};
};
INSTANTIATE_TEST_SUITE_P(Modes, BothFilters, ::testing::Values(FilterMode::kLattice, FilterMode::kTay2008));

TEST_P(BothFilters, WhatIsNotSeenIsUnknown) {
  auto filter = make();
  const GridGeometry g = geometry();
  for (int step = 0; step < 5; ++step) filter->update(g, std::vector<float>(g.cells(), 0.5F), 0.05, one_);
  for (const float p : filter->cells().occupied) EXPECT_NEAR(p, 0.5, 1e-4);
}

TEST_P(BothFilters, ProbabilitiesStayProbabilities) {
  auto filter = make();
  for (int step = 0; step < 40; ++step) {
    const GridGeometry g = geometry(step / 2, -step / 3);
    filter->update(g, evidenceOf(g, 20.0 + 1.3 * step, 30.0, 9, 4), step % 7 == 0 ? 0.0 : 0.05, one_);
    const CellEstimates& cells = filter->cells();
    for (std::size_t i = 0; i < g.cells(); ++i) {
      ASSERT_TRUE(cells.occupied[i] >= 0.0F && cells.occupied[i] <= 1.0F) << cells.occupied[i];
      ASSERT_TRUE(cells.unknown[i] >= 0.0F && cells.unknown[i] <= 1.0F);
      ASSERT_TRUE(cells.static_share[i] >= 0.0F && cells.static_share[i] <= 1.0001F);
      ASSERT_TRUE(cells.moving[i] <= cells.occupied[i] + 1e-4F);
      ASSERT_GE(cells.var_xx[i], 0.0F);
      ASSERT_GE(cells.var_xx[i] * cells.var_yy[i] - cells.var_xy[i] * cells.var_xy[i],
                -1e-2F * (1.0F + cells.var_xx[i] * cells.var_yy[i]));
    }
  }
}

TEST_P(BothFilters, TheGridMayScrollUnderAStandingThing) {
  FilterParams params;
  params.mode = GetParam();
  params.levels_mps = {1.5, 3.0};  // slow enough that nothing from beyond the borders comes so far
  auto still = makeFilter(params), scrolled = makeFilter(params);
  for (int step = 0; step < 10; ++step) {
    const GridGeometry here = geometry(), there = geometry(step / 2, -step / 3);
    still->update(here, evidenceOf(here, 30.0, 28.0, 6, 5), 0.05, one_);
    scrolled->update(there, evidenceOf(there, 30.0, 28.0, 6, 5), 0.05, one_);
  }
  const GridGeometry here = geometry(), there = geometry(4, -3);
  for (int row = 26; row < 36; ++row) {
    for (int column = 28; column < 38; ++column) {
      const std::size_t a = here.indexOf(column, row), b = there.indexOf(column - 4, row + 3);
      EXPECT_EQ(still->cells().occupied[a], scrolled->cells().occupied[b]) << column << " " << row;
      EXPECT_EQ(still->cells().vx_mps[a], scrolled->cells().vx_mps[b]);
    }
  }
}

TEST_P(BothFilters, NewCellsAreUnknown) {
  auto filter = make();
  const GridGeometry here = geometry(), far = geometry(1000, -1000);
  for (int step = 0; step < 5; ++step) filter->update(here, evidenceOf(here, 10.0, 10.0, 5, 5), 0.05, one_);
  filter->update(far, std::vector<float>(far.cells(), 0.5F), 0.05, one_);
  for (const float p : filter->cells().occupied) EXPECT_NEAR(p, 0.5, 1e-4);
}

TEST_P(BothFilters, TwoThreadsGiveTheSameBits) {
  auto a = make(), b = make();
  RowWorkers two(2), three(3);
  for (int step = 0; step < 12; ++step) {
    const GridGeometry g = geometry(step, 0);
    const std::vector<float> evidence = evidenceOf(g, 15.0 + 1.5 * step, 20.0, 12, 6);
    a->update(g, evidence, 0.05, two);
    b->update(g, evidence, 0.05, three);
  }
  auto c = make();
  for (int step = 0; step < 12; ++step) {
    const GridGeometry g = geometry(step, 0);
    c->update(g, evidenceOf(g, 15.0 + 1.5 * step, 20.0, 12, 6), 0.05, one_);
  }
  EXPECT_EQ(a->cells().occupied, c->cells().occupied);
  EXPECT_EQ(b->cells().occupied, c->cells().occupied);
  EXPECT_EQ(a->cells().vx_mps, c->cells().vx_mps);
  EXPECT_EQ(b->cells().var_xy, c->cells().var_xy);
}

TEST_P(BothFilters, ResetForgets) {
  auto filter = make();
  const GridGeometry g = geometry();
  filter->update(g, evidenceOf(g, 10.0, 10.0, 5, 5), 0.05, one_);
  filter->reset();
  filter->update(g, std::vector<float>(g.cells(), 0.5F), 0.05, one_);
  for (const float p : filter->cells().occupied) EXPECT_NEAR(p, 0.5, 1e-4);
}

/// Mean velocity over the cells of what a sensor sees of a car that drives away along x, its rear, and its
/// consistency.
struct Driven {
  double vx = 0, vy = 0, nees = 0, static_share = 0;
  int cells = 0;
};
Driven drive(FilterMode mode, double speed_mps, double dt_s) {
  FilterParams params;
  params.mode = mode;
  auto filter = makeFilter(params);
  RowWorkers one(1);
  const GridGeometry g = geometry();
  double x = 5.0;
  const double duration_s = std::min(3.0, 9.0 / speed_mps);
  for (double t = 0.0; t < duration_s; t += dt_s) {
    filter->update(g, evidenceOf(g, x, 28.0, 2, 9), t == 0.0 ? 0.0 : dt_s, one);
    x += speed_mps * dt_s / g.cell_m;
  }
  x -= speed_mps * dt_s / g.cell_m;
  Driven result;
  const CellEstimates& cells = filter->cells();
  for (int row = 30; row < 35; ++row) {
    for (int column = static_cast<int>(std::lround(x)); column < static_cast<int>(std::lround(x)) + 2;
         ++column) {
      const std::size_t i = g.indexOf(column, row);
      result.vx += cells.vx_mps[i];
      result.vy += cells.vy_mps[i];
      result.static_share += cells.static_share[i];
      const double error = cells.vx_mps[i] - speed_mps;
      result.nees += error * error / (cells.var_xx[i] + 0.5);  // and the lattice's own step
      ++result.cells;
    }
  }
  result.vx /= result.cells;
  result.vy /= result.cells;
  result.static_share /= result.cells;
  result.nees /= result.cells;
  return result;
}

TEST(LatticeFilter, FindsTheVelocityOfABoxThatDrivesIntoFreeSpace) {
  for (const double speed : {1.5, 3.5, 6.0}) {
    const Driven on_lattice = drive(FilterMode::kLattice, speed, 0.05);
    EXPECT_NEAR(on_lattice.vx, speed, 1.0) << speed;
    EXPECT_NEAR(on_lattice.vy, 0.0, 0.5) << speed;
    EXPECT_LT(on_lattice.static_share, 0.4) << speed;
  }
  const Driven between = drive(FilterMode::kLattice, 4.7, 0.05);
  EXPECT_NEAR(between.vx, 4.7, 1.2);
  EXPECT_LT(between.nees, 3.0);  // 1 when consistent; cells of a box err together
}

TEST(LatticeFilter, TimeStepsNeedNotBeEven) {
  for (const double dt_s : {0.02, 0.035, 0.08}) {
    const Driven driven = drive(FilterMode::kLattice, 3.5, dt_s);
    EXPECT_NEAR(driven.vx, 3.5, 0.8) << dt_s;
  }
}

TEST(LatticeFilter, AStandingThingStandsAndIsForgottenLastWhenHidden) {
  auto filter = makeFilter(FilterParams{});
  RowWorkers one(1);
  const GridGeometry g = geometry();
  for (int step = 0; step < 40; ++step) filter->update(g, evidenceOf(g, 30.0, 30.0, 6, 6), 0.05, one);
  const std::size_t inside = g.indexOf(33, 33), outside = g.indexOf(10, 10);
  EXPECT_GT(filter->cells().occupied[inside], 0.95F);
  EXPECT_GT(filter->cells().static_share[inside], 0.8F);
  EXPECT_LT(filter->cells().occupied[outside], 0.05F);
  for (int step = 0; step < 20; ++step) filter->update(g, std::vector<float>(g.cells(), 0.5F), 0.05, one);
  EXPECT_GT(filter->cells().occupied[inside], 0.8F);
  EXPECT_NEAR(filter->cells().occupied[outside], 0.5, 0.1);  // what was free may not be any more
}

TEST(LatticeFilter, WhatLeavesIsGoneSoon) {
  auto filter = makeFilter(FilterParams{});
  RowWorkers one(1);
  const GridGeometry g = geometry();
  for (int step = 0; step < 40; ++step) filter->update(g, evidenceOf(g, 30.0, 30.0, 6, 6), 0.05, one);
  for (int step = 0; step < 10; ++step) filter->update(g, std::vector<float>(g.cells(), 0.2F), 0.05, one);
  EXPECT_LT(filter->cells().occupied[g.indexOf(33, 33)], 0.2F);
}

TEST(OccupancyFilter, RefusesBadParameters) {
  FilterParams params;
  params.levels_mps = {2.0, 1.0};
  EXPECT_THROW(makeFilter(params), std::invalid_argument);
  params = {};
  params.levels_mps.clear();
  EXPECT_THROW(makeFilter(params), std::invalid_argument);
  params = {};
  params.static_share = 1.5;
  EXPECT_THROW(makeFilter(params), std::invalid_argument);
  params = {};
  params.forget_free_s = 0.0;
  EXPECT_THROW(makeFilter(params), std::invalid_argument);
}

TEST(OccupancyFilter, AStepBackOrAnotherSizeIsABug) {
  auto filter = makeFilter(FilterParams{});
  RowWorkers one(1);
  const GridGeometry g = geometry();
  EXPECT_THROW(filter->update(g, std::vector<float>(g.cells(), 0.5F), -0.1, one), std::logic_error);
  EXPECT_THROW(filter->update(g, std::vector<float>(3, 0.5F), 0.1, one), std::logic_error);
}

}  // namespace
}  // namespace atlas
