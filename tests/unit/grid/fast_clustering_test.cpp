// SPDX-License-Identifier: MIT
#include "atlas/grid/fast_clustering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "grid_by_hand.hpp"

namespace atlas {
namespace {

constexpr Stamp kStart = 1'500'000'000 * kSecond;

class FastClusteringTest : public ::testing::Test {
 protected:
  void look(const GridByHand& grid, double t_s) {
    tracker_.update(
        {kStart + fromSeconds(t_s), grid.geometry, grid.cells, grid.evidence, grid.top_m, {-5.0, 10.0}, 0.0},
        counters_);
  }
  ClusterTracker tracker_{ClusterTrackParams{}};
  Counters counters_;
};

int cellOf(double m) { return static_cast<int>(std::lround(m / 0.2)); }

TEST_F(FastClusteringTest, ACarIsToldOfAfterThreeLooksWithItsBoxAndVelocity) {
  for (int k = 0; k < 40; ++k) {
    GridByHand grid;
    grid.put(cellOf(2.0 + 4.0 * 0.05 * k), 40, 22, 9, {4.0, 0.0});
    look(grid, 0.05 * k);
    EXPECT_EQ(tracker_.report().objects.size(), k < 2 ? 0U : 1U) << k;
  }
  const Object car = tracker_.report().objects.front();
  EXPECT_EQ(car.id, 1U);
  EXPECT_NEAR(car.velocity_mps.x(), 4.0, 0.3);
  EXPECT_NEAR(car.velocity_mps.y(), 0.0, 0.3);
  EXPECT_NEAR(car.size.x(), 4.4, 0.4);
  EXPECT_NEAR(car.size.y(), 1.8, 0.4);
  EXPECT_NEAR(car.size.z(), 1.4, 0.01);
  EXPECT_NEAR(car.position.x(), 2.0 + 4.0 * 1.95 + 2.2, 0.3);
  EXPECT_FALSE(car.is_static);
  EXPECT_TRUE(car.heading_known);
}

TEST_F(FastClusteringTest, StatesAreAsUncertainAsTheySay) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.15);
  double nees = 0.0;
  int count = 0;
  for (int k = 0; k < 200; ++k) {
    GridByHand grid;
    const double x = 1.0 + 1.5 * 0.05 * k;
    grid.put(cellOf(x + noise(random)), cellOf(8.0 + noise(random)), 9, 4, {1.5, 0.0}, 0.5F);
    look(grid, 0.05 * k);
    if (k < 40) continue;
    const Object bicycle = tracker_.report().objects.front();
    Eigen::Matrix4d P;
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c) P(r, c) = bicycle.covariance[static_cast<std::size_t>(5 * r + c)];
    }
    Eigen::Vector4d e;
    e << bicycle.position.x() - (x + 0.9), bicycle.position.y() - 8.4, bicycle.velocity_mps.x() - 1.5,
        bicycle.velocity_mps.y();
    nees += e.dot(P.inverse() * e);
    ++count;
  }
  nees /= count;
  EXPECT_GT(nees, 0.5);  // 4 when exactly consistent; more is careful, less than a half of it is not
  EXPECT_LT(nees, 8.0);
}

TEST_F(FastClusteringTest, TwoThatWalkTogetherAndTouchForAWhileStayTwo) {
  for (int k = 0; k < 60; ++k) {
    GridByHand grid;
    const double gap = std::min(1.2, std::abs(0.05 * k - 1.5) * 6.0);  // touch at 1.5 s
    grid.put(cellOf(3.0 + 1.4 * 0.05 * k), cellOf(10.0 + 0.5 * gap), 3, 3, {1.4, 0.1});
    grid.put(cellOf(3.0 + 1.4 * 0.05 * k), cellOf(9.4 - 0.5 * gap), 3, 3, {1.4, -0.1});
    look(grid, 0.05 * k);
  }
  const Objects objects = tracker_.report();
  EXPECT_EQ(objects.objects.size(), 2U);
}

TEST_F(FastClusteringTest, TwoTracksOfOneThingAreMerged) {
  for (int k = 0; k < 40; ++k) {
    GridByHand grid;
    const int x = cellOf(2.0 + 3.0 * 0.05 * k);
    if (k < 10) {  // first only its ends are seen
      grid.put(x, 40, 5, 9, {3.0, 0.0});
      grid.put(x + 17, 40, 5, 9, {3.0, 0.0});
    } else {
      grid.put(x, 40, 22, 9, {3.0, 0.0});
    }
    look(grid, 0.05 * k);
    if (k == 8) {
      EXPECT_EQ(tracker_.report().objects.size(), 2U);
    }
  }
  ASSERT_EQ(tracker_.report().objects.size(), 1U);
  EXPECT_EQ(tracker_.report().objects.front().id, 1U);  // the older one's
  EXPECT_GE(counters_.get("grid tracks merged"), 1U);
}

TEST_F(FastClusteringTest, HiddenThingsAreRememberedLongerThanThoseThatAreSeenToBeGone) {
  for (const bool hidden : {true, false}) {
    tracker_.reset();
    const double start = hidden ? 0.0 : 10.0;
    for (int k = 0; k < 20; ++k) {
      GridByHand grid;
      grid.put(40, 40, 9, 9, {0.0, 0.0});
      look(grid, start + 0.05 * k);
    }
    ASSERT_EQ(tracker_.report().objects.size(), 1U);
    GridByHand gone;
    if (hidden) gone.evidence.assign(gone.geometry.cells(), 0.5F);
    for (int k = 20; k < 60; ++k) look(gone, start + 0.05 * k);  // two seconds
    EXPECT_EQ(tracker_.report().objects.size(), hidden ? 1U : 0U);
  }
}

TEST_F(FastClusteringTest, AWallIsNoObject) {
  for (int k = 0; k < 10; ++k) {
    GridByHand grid;
    grid.put(0, 90, 100, 2, {0.0, 0.0});  // 20 m
    grid.put(0, 92, 100, 1, {0.0, 0.0});
    look(grid, 0.05 * k);
  }
  ClusterTrackParams params;
  params.max_length_m = 10.0;
  ClusterTracker strict(params);
  GridByHand grid;
  grid.put(0, 90, 100, 2, {0.0, 0.0});
  for (int k = 0; k < 10; ++k)
    strict.update({kStart + k * 50 * kMillisecond,
                   grid.geometry,
                   grid.cells,
                   grid.evidence,
                   grid.top_m,
                   {0.0, 0.0},
                   0.0},
                  counters_);
  EXPECT_TRUE(strict.report().objects.empty());
}

TEST(ClusterTrackParams, AreChecked) {
  ClusterTrackParams params;
  params.ambiguous_same = 0.1;
  EXPECT_THROW(ClusterTracker{params}, std::invalid_argument);
  params = {};
  params.confirm_hits = 6;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.lost_hidden_s = 0.5;
  EXPECT_THROW(validate(params), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
