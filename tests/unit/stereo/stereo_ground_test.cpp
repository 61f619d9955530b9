// SPDX-License-Identifier: MIT
#include "atlas/stereo/stereo_ground.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "scene.hpp"

namespace atlas::test {
namespace {

/// One bin of disparity that is occupied in all columns, all others empty.
UDisparityGrid wallAt(double disparity_px, int range_px, const UDisparityParams& params) {
  UDisparityGrid grid;
  grid.columns = lexusRig().width_px;
  grid.bins_per_px = params.bins_per_px;
  grid.bins = range_px * params.bins_per_px;
  grid.occupancy.assign(static_cast<std::size_t>(grid.columns) * grid.bins, kProbabilityOne / 20);
  const int bin = static_cast<int>(disparity_px * params.bins_per_px);
  std::fill_n(grid.occupancy.begin() + static_cast<std::ptrdiff_t>(bin) * grid.columns, grid.columns,
              static_cast<std::uint16_t>(0.98 * kProbabilityOne));
  return grid;
}

double logOdds(float p) { return std::log(p / (1.0F - p)); }

const GroundCells kCells{0.0, -20.0, 0.2, 200, 200};

/// Within the view every cell at the wall's distance holds it, near as far.
TEST(StereoGround, HasNoHoles) {
  const StereoRig rig = lexusRig();
  const UDisparityParams params;
  StereoGround ground(rig, 64, params, kCells);
  for (const double depth_m : {3.0, 6.0, 12.0, 30.0}) {
    const double d = rig.disparityAt(depth_m);
    const double middle_m = rig.depthOf((std::floor(d * params.bins_per_px) + 0.5) / params.bins_per_px);
    const int column = static_cast<int>(middle_m / kCells.cell_m);
    const std::vector<float>& cells = ground.fill(wallAt(d, 64, params));
    const double left_m = rig.u0_px / rig.focal_px * middle_m,
                 right_m = (511.0 - rig.u0_px) / rig.focal_px * middle_m;
    int inside = 0;
    for (int row = 0; row < kCells.rows; ++row) {
      const double y_m = kCells.origin_y_m + (row + 0.5) * kCells.cell_m;
      const float p = cells[static_cast<std::size_t>(row * kCells.columns + column)];
      if (y_m < left_m - 0.2 && y_m > 0.2 - right_m) {
        EXPECT_GT(p, 0.5F) << depth_m << " m ahead, " << y_m << " m left";
        ++inside;
      } else if (y_m > left_m + 0.2 || y_m < -right_m - 0.2) {
        EXPECT_EQ(p, 0.5F) << depth_m << " m ahead, " << y_m << " m left";
      }
    }
    EXPECT_GT(inside, 10);
  }
}

/// However many cells a bin of disparity covers, together they hold the evidence of one: a far thing is not
/// painted as a bar.
TEST(StereoGround, SharesTheEvidenceOfABin) {
  const StereoRig rig = lexusRig();
  const UDisparityParams params;
  StereoGround ground(rig, 64, params, kCells);
  for (const double depth_m : {12.0, 20.0, 30.0}) {
    const std::vector<float>& cells = ground.fill(wallAt(rig.disparityAt(depth_m), 64, params));
    double sum = 0;
    int covered = 0;
    for (int column = 0; column < kCells.columns; ++column) {
      const float p = cells[static_cast<std::size_t>(100 * kCells.columns + column)];
      if (p <= 0.5F) continue;
      sum += logOdds(p);
      ++covered;
    }
    const double bin_m = depth_m * depth_m / (rig.focal_px * rig.baseline_m) / params.bins_per_px;
    EXPECT_NEAR(covered * kCells.cell_m, bin_m, 1.0 * bin_m) << depth_m;  // linear between bins: up to twice
    EXPECT_LT(sum, 1.3 * logOdds(0.98F)) << depth_m;
    // least where a bin meets two cells a quarter of it from its middle: P = 0.75 each, half of its evidence
    EXPECT_GT(sum, 0.25 * logOdds(0.98F)) << depth_m;
  }
}

TEST(StereoGround, KnowsNothingBehindTheCameraOrNearerThanTheRange) {
  const UDisparityParams params;
  StereoGround ground(lexusRig(), 64, params, {-4.0, -2.0, 0.2, 40, 20});
  const std::vector<float>& cells = ground.fill(wallAt(20.0, 64, params));
  for (int column = 0; column < 40; ++column) {
    const double x_m = -4.0 + (column + 0.5) * 0.2;
    if (x_m < lexusRig().depthOf(63.0)) {
      EXPECT_EQ(cells[static_cast<std::size_t>(10 * 40 + column)], 0.5F) << x_m;
    }
  }
}

TEST(StereoGround, RefusesAGridOfAnotherRig) {
  const UDisparityParams params;
  StereoGround ground(lexusRig(), 32, params, kCells);
  EXPECT_THROW(ground.fill(wallAt(20.0, 64, params)), std::invalid_argument);
  EXPECT_THROW(StereoGround(lexusRig(), 64, params, {0.0, 0.0, 0.0, 10, 10}), std::invalid_argument);
  EXPECT_THROW(StereoGround(lexusRig(), 64, params, {0.0, 0.0, 0.2, 10, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
