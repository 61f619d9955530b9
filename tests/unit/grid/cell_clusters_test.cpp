// SPDX-License-Identifier: MIT
#include "atlas/grid/cell_clusters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "atlas/grid/share_out.hpp"
#include "grid_by_hand.hpp"

namespace atlas {
namespace {

CellClusters clustersOf(const GridByHand& grid) {
  return clusterCells({grid.geometry, grid.cells, grid.evidence, grid.top_m}, 0.6, 2.5);
}

TEST(CellClusters, CellsThatTouchAreOneClusterCornersToo) {
  GridByHand grid;
  grid.put(10, 10, 3, 2, {0.0, 0.0});
  grid.put(13, 12, 2, 2, {0.0, 0.0});  // touches at a corner
  grid.put(20, 20, 2, 2, {0.0, 0.0});
  const CellClusters found = clustersOf(grid);
  ASSERT_EQ(found.clusters.size(), 2U);
  EXPECT_EQ(found.clusters[0].size(), 10U);
  EXPECT_EQ(found.clusters[1].size(), 4U);
  EXPECT_EQ(found.cluster_of_cell[grid.geometry.indexOf(21, 21)], 2);
  EXPECT_EQ(found.cluster_of_cell[grid.geometry.indexOf(5, 5)], 0);
}

TEST(CellClusters, ABicycleBesideACarIsCutOff) {
  GridByHand grid;
  grid.put(10, 10, 20, 4, {1.5, 0.0});
  grid.put(15, 14, 8, 2, {5.0, 0.0});
  const CellClusters found = clustersOf(grid);
  ASSERT_EQ(found.clusters.size(), 2U);
  EXPECT_EQ(found.clusters[0].size(), 80U);
  EXPECT_EQ(found.clusters[1].size(), 16U);
}

TEST(CellClusters, ATurningCarStaysWhole) {
  GridByHand grid;
  for (int column = 0; column < 22; ++column)  // the front moves 2.1 m/s otherwise than the rear and more
    grid.put(10 + column, 10, 1, 8, {5.0, 0.3 * column});
  EXPECT_EQ(clustersOf(grid).clusters.size(), 1U);
}

TEST(CellClusters, CellsThatDoNotKnowTheirVelocityCutNothingOff) {
  GridByHand grid;
  grid.put(10, 10, 5, 4, {6.0, 0.0}, 8.0F);
  grid.put(15, 10, 5, 4, {0.0, 0.0}, 8.0F);
  EXPECT_EQ(clustersOf(grid).clusters.size(), 1U);
}

TEST(CellClusters, NothingFromNothing) { EXPECT_TRUE(clustersOf(GridByHand{}).clusters.empty()); }

TEST(GroundBoxes, LieAlongTheCells) {
  GridByHand grid;
  grid.put(10, 10, 20, 8, {0.0, 0.0});
  const Cluster cluster = clustersOf(grid).clusters.front();
  const GroundBox box = principalBox(cluster, 0.2);
  EXPECT_NEAR(box.length, 4.0, 1e-9);
  EXPECT_NEAR(box.width, 1.6, 1e-9);
  EXPECT_NEAR(std::remainder(box.yaw_rad, M_PI), 0.0, 1e-9);
  EXPECT_NEAR(box.center.x(), 4.0, 1e-9);
  const GroundBox turned = boxAlong(cluster, M_PI / 2.0, 0.2);
  EXPECT_NEAR(turned.length, 1.6, 1e-9);
}

TEST(GroundBoxes, TwoSidesOfACarAreNoDiagonal) {
  GridByHand grid;
  grid.put(10, 10, 22, 1, {0.0, 0.0});
  grid.put(10, 11, 1, 8, {0.0, 0.0});
  const Cluster cluster = clustersOf(grid).clusters.front();
  const GroundBox box = outlineBox(cluster, {0.0, 0.0}, 0.2);
  EXPECT_LT(std::abs(std::remainder(box.yaw_rad, M_PI / 2.0)), 0.05);
  EXPECT_NEAR(std::max(box.length, box.width), 4.4, 0.3);
}

TEST(ShareOut, GivesEachSeedItsOwnCells) {
  GridByHand grid;
  grid.put(10, 10, 10, 3, {1.4, 0.0});
  const Cluster cluster = clustersOf(grid).clusters.front();
  const std::vector<std::size_t> owner = shareOut(cluster, {{2.4, 2.3, 1.4, 0.0}, {3.6, 2.3, 1.4, 0.0}});
  for (std::size_t i = 0; i < cluster.size(); ++i)
    EXPECT_EQ(owner[i], cluster[i].position.x() < 3.0 ? 0U : 1U);
}

TEST(ShareOut, AVelocityTellsCellsApartThatLieTogether) {
  Cluster cluster(2);
  cluster[0].position = cluster[1].position = {1.0, 1.0};
  cluster[0].velocity = {0.0, 0.0};
  cluster[1].velocity = {6.0, 0.0};
  cluster[0].weight = cluster[1].weight = 1.0;
  const auto owner = shareOut(cluster, {{1.1, 1.0, 6.0, 0.0}, {1.1, 1.0, 0.0, 0.0}});
  EXPECT_EQ(owner[0], 1U);
  EXPECT_EQ(owner[1], 0U);
}

}  // namespace
}  // namespace atlas
