// SPDX-License-Identifier: MIT
#include "atlas/lidar/clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace atlas {
namespace {

using Clusters = std::vector<std::vector<std::uint32_t>>;

LidarPoint at(double x, double y, double z = 0) {
  LidarPoint p;
  p.x = static_cast<float>(x);
  p.y = static_cast<float>(y);
  p.z = static_cast<float>(z);
  return p;
}

const Eigen::Vector3d kVehicle(0.0, 0.0, 1.7);

/// Without walls and without growth by range: only the two gaps count.
ClusterParams plain(double tolerance_m, double step_m) {
  ClusterParams p;
  p.tolerance_m = tolerance_m;
  p.step_m = step_m;
  p.tolerance_per_m = p.step_per_m = 0.0;
  p.tall_m = 1e9;
  return p;
}

/// All pairs compared: joined by a chain of points with steps of at most these gaps.
Clusters bruteForce(const std::vector<LidarPoint>& points, double tolerance_m, double step_m) {
  std::vector<int> cluster(points.size(), -1);
  Clusters result;
  for (std::size_t seed = 0; seed < points.size(); ++seed) {
    if (cluster[seed] >= 0) continue;
    std::vector<std::uint32_t> members = {static_cast<std::uint32_t>(seed)};
    cluster[seed] = static_cast<int>(result.size());
    for (std::size_t k = 0; k < members.size(); ++k) {
      for (std::size_t j = 0; j < points.size(); ++j) {
        const LidarPoint &p = points[members[k]], &q = points[j];
        const double dx = double(p.x) - q.x, dy = double(p.y) - q.y, dz = double(p.z) - q.z;
        if (cluster[j] >= 0 || dx * dx + dy * dy > tolerance_m * tolerance_m || std::abs(dz) > step_m)
          continue;
        cluster[j] = static_cast<int>(result.size());
        members.push_back(static_cast<std::uint32_t>(j));
      }
    }
    std::sort(members.begin(), members.end());
    result.push_back(members);
  }
  return result;
}

/// True when every cluster of `fine` lies within one of `coarse`.
bool isRefinement(const Clusters& fine, const Clusters& coarse) {
  std::map<std::uint32_t, std::size_t> home;
  for (std::size_t c = 0; c < coarse.size(); ++c) {
    for (const std::uint32_t i : coarse[c]) home[i] = c;
  }
  return std::all_of(fine.begin(), fine.end(), [&](const std::vector<std::uint32_t>& cluster) {
    return std::all_of(cluster.begin(), cluster.end(),
                       [&](std::uint32_t i) { return home.at(i) == home.at(cluster.front()); });
  });
}

/// Outline of a car of 4 x 1.8 m with its rear left corner at (x, y), a point every 0.15 m.
void addCar(std::vector<LidarPoint>& points, double x, double y) {
  for (double s = 0.0; s <= 4.0; s += 0.15) {
    for (double z = 0.3; z <= 1.5; z += 0.15) {
      points.push_back(at(x + s, y, z));
      points.push_back(at(x + s, y + 1.8, z));
    }
  }
  for (double s = 0.0; s <= 1.8; s += 0.15) {
    for (double z = 0.3; z <= 1.5; z += 0.15) {
      points.push_back(at(x, y + s, z));
      points.push_back(at(x + 4.0, y + s, z));
    }
  }
}

/// A wall of 4 m along x at y, seen from (from_m, to_m).
void addWall(std::vector<LidarPoint>& points, double y, double from_m, double to_m) {
  for (double x = from_m; x <= to_m; x += 0.08) {
    for (double z = 0.3; z <= 4.0; z += 0.25) points.push_back(at(x, y, z));
  }
}

/// A person's front, 0.44 m wide, its middle at (x, y).
void addPerson(std::vector<LidarPoint>& points, double x, double y) {
  for (double across = -0.22; across <= 0.221; across += 0.05) {
    for (double z = 0.3; z <= 1.7; z += 0.2)
      points.push_back(at(x + across, y - std::sqrt(std::max(0.0, 0.0484 - across * across)), z));
  }
}

TEST(Clusters, TwoCarsSideBySideAreTwo) {
  std::vector<LidarPoint> points;
  addCar(points, 4, 0);
  const std::size_t first = points.size();
  addCar(points, 4.5, 1.8 + 0.5);  // a gap of 0.5 m; 0.3 m + 2 % of the range are bridged
  const Clusters clusters = findClusters(points, kVehicle, {});
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_EQ(clusters[0].size(), first);
  EXPECT_EQ(clusters[0].front(), 0U);
  EXPECT_EQ(clusters[1].front(), first);
  EXPECT_EQ(findClusters(points, kVehicle, plain(0.55, 0.35)).size(), 1U) << "a wider tolerance joins them";
}

TEST(Clusters, ToleranceGrowsWithTheRange) {
  // the grille and the screen of a car: 0.8 m apart, and rings 0.7 m apart on a person
  const auto twoParts = [](double range_m) {
    return std::vector<LidarPoint>{at(range_m, 0, 0.6), at(range_m + 0.8, 0, 0.9), at(range_m, 10, 0.4),
                                   at(range_m, 10, 1.2)};
  };
  EXPECT_EQ(findClusters(twoParts(8.0), kVehicle, {}).size(), 4U);
  EXPECT_EQ(findClusters(twoParts(28.0), kVehicle, {}).size(), 2U);
  EXPECT_EQ(findClusters(twoParts(28.0), {28.0, 5.0, 1.7}, {}).size(), 4U) << "range counts from the vehicle";
  ClusterParams params;
  params.tolerance_per_m = params.step_per_m = 0.0;
  EXPECT_EQ(findClusters(twoParts(28.0), kVehicle, params).size(), 4U) << "no growth, no join";
}

TEST(Clusters, ACrownAboveACarDoesNotJoinIt) {
  std::vector<LidarPoint> points;
  addCar(points, 10, 0);
  const std::size_t car = points.size();
  for (double x = 10; x < 13; x += 0.2) {
    for (double y = 0; y < 2; y += 0.2) points.push_back(at(x, y, 2.4 + 0.1 * y));
  }
  const Clusters clusters = findClusters(points, kVehicle, {});
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_EQ(clusters[0].size(), car);
}

TEST(Clusters, AWallDoesNotSwallowThePersonBeforeIt) {
  std::vector<LidarPoint> points;
  addWall(points, 8.0, -10.0, 10.0);
  const std::size_t wall = points.size();
  addPerson(points, 3.0, 7.5);  // 0.28 m of air between back and wall, but nobody sees the back
  const std::size_t both = points.size();
  const Clusters clusters = findClusters(points, kVehicle, {});
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_EQ(clusters[0].size(), wall);
  EXPECT_EQ(clusters[1].size(), both - wall);
  ClusterParams params;
  params.tall_m = 1e9;
  EXPECT_EQ(findClusters(points, kVehicle, {}).size(), 2U);
  params.tolerance_m = 0.6;
  EXPECT_EQ(findClusters(points, kVehicle, params).size(), 1U) << "without the rule they are one";
}

TEST(Clusters, TheLowRestOfAWallBelongsToIt) {
  std::vector<LidarPoint> points;
  addWall(points, 8.0, -10.0, 0.0);
  for (double x = 0.05; x <= 0.6; x += 0.08) {  // a car hides all above it
    for (double z = 0.3; z <= 1.5; z += 0.25) points.push_back(at(x, 8.0, z));
  }
  EXPECT_EQ(findClusters(points, kVehicle, {}).size(), 1U);
}

TEST(Clusters, ACabIsNoObjectBeforeItsLorry) {
  // bonnet below, cab above it: neither is tall alone, together they are taller than people and cars
  std::vector<LidarPoint> points;
  addWall(points, 8.0, 0.0, 6.0);  // the side of the load
  for (double x = 6.35; x <= 7.6; x += 0.1) {
    for (double z = 0.3; z <= 1.2; z += 0.2) points.push_back(at(x, 8.0, z));
    for (double z = 1.2; z <= 2.7; z += 0.2) points.push_back(at(x + 0.3, 8.3, z));
  }
  EXPECT_EQ(findClusters(points, kVehicle, {}).size(), 1U);
}

TEST(Clusters, BetweenAllPairsWithTheGapsAndWithTheGapsAndAColumn) {
  std::mt19937 random(11);
  const ClusterParams params = plain(0.4, 0.3);
  const double diagonal_m = params.column_m * std::sqrt(2.0);
  for (const double spread_m : {3.0, 6.0, 12.0}) {
    std::uniform_real_distribution<double> coordinate(-spread_m, spread_m);
    std::vector<LidarPoint> points;
    for (int i = 0; i < 700; ++i)
      points.push_back(at(coordinate(random), coordinate(random), coordinate(random) / 4));
    const Clusters clusters = findClusters(points, kVehicle, params);
    const Clusters tight = bruteForce(points, params.tolerance_m, params.step_m);
    // pieces stand for their points: they reach at most a diagonal, and a chain of steps within it, further
    const Clusters wide = bruteForce(points, params.tolerance_m + 2.0 * diagonal_m, 1e9);
    EXPECT_GT(clusters.size(), 1U);
    EXPECT_TRUE(isRefinement(tight, clusters)) << spread_m;
    EXPECT_TRUE(isRefinement(clusters, wide)) << spread_m;
  }
}

TEST(Clusters, PartitionDoesNotDependOnTheOrderOfPoints) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(-5.0, 5.0);
  std::vector<LidarPoint> points;
  for (int i = 0; i < 400; ++i) {
    points.push_back(at(coordinate(random), coordinate(random), 0.7 * coordinate(random)));
    points.back().ring = static_cast<std::uint16_t>(i);  // its name
  }
  const auto partition = [](const std::vector<LidarPoint>& p) {
    std::vector<std::vector<int>> named;
    for (const auto& cluster : findClusters(p, kVehicle, {})) {
      named.emplace_back();
      for (const std::uint32_t i : cluster) named.back().push_back(p[i].ring);
      std::sort(named.back().begin(), named.back().end());
    }
    std::sort(named.begin(), named.end());
    return named;
  };
  const auto expected = partition(points);
  for (int run = 0; run < 5; ++run) {
    std::shuffle(points.begin(), points.end(), random);
    EXPECT_EQ(partition(points), expected);
  }
}

TEST(Clusters, Edges) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(findClusters({}, kVehicle, {}).empty());
  EXPECT_EQ(findClusters({at(1, 2, 3)}, kVehicle, {}), Clusters({{0}}));
  EXPECT_EQ(findClusters({at(nan, 0), at(1, 1), at(1, 1, nan)}, kVehicle, {}), Clusters({{1}}));
  EXPECT_THROW((void)findClusters({}, kVehicle, plain(0.0, 0.3)), std::invalid_argument);
  EXPECT_THROW((void)findClusters({}, kVehicle, plain(0.3, 0.0)), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
