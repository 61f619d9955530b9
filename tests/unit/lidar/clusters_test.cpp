// SPDX-License-Identifier: MIT
#include "atlas/lidar/clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
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

/// All pairs compared.
Clusters bruteForce(const std::vector<LidarPoint>& points, double tolerance_m) {
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
        if (cluster[j] >= 0 || dx * dx + dy * dy + dz * dz > tolerance_m * tolerance_m) continue;
        cluster[j] = static_cast<int>(result.size());
        members.push_back(static_cast<std::uint32_t>(j));
      }
    }
    std::sort(members.begin(), members.end());
    result.push_back(members);
  }
  return result;
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

TEST(Clusters, TwoCarsSideBySideAreTwo) {
  std::vector<LidarPoint> points;
  addCar(points, 10, 0);
  const std::size_t first = points.size();
  addCar(points, 10.5, 1.8 + 0.6);  // a gap of 0.6 m
  const Clusters clusters = euclideanClusters(points, 0.5);
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_EQ(clusters[0].size(), first);
  EXPECT_EQ(clusters[0].front(), 0U);
  EXPECT_EQ(clusters[1].front(), first);
  EXPECT_EQ(euclideanClusters(points, 0.65).size(), 1U) << "a wider tolerance joins them";
}

TEST(Clusters, ExactlyTheToleranceJoins) {
  EXPECT_EQ(euclideanClusters({at(0, 0), at(0.5, 0)}, 0.5).size(), 1U);
  EXPECT_EQ(euclideanClusters({at(0, 0), at(0.5001, 0)}, 0.5).size(), 2U);
  EXPECT_EQ(euclideanClusters({at(0, 0, 0), at(0.3, 0.4, 0)}, 0.5 + 1e-7).size(), 1U);
  // the corners of one grid cell, and points whose cells lie two apart
  EXPECT_EQ(euclideanClusters({at(0.001, 0.001, 0.001), at(0.28, 0.28, 0.28)}, 0.5).size(), 1U);
  EXPECT_EQ(euclideanClusters({at(0.28, 0, 0), at(0.28 + 0.49, 0, 0)}, 0.5).size(), 1U);
}

TEST(Clusters, SameAsAllPairs) {
  std::mt19937 random(11);
  for (const double spread_m : {3.0, 6.0, 12.0}) {
    std::uniform_real_distribution<double> coordinate(-spread_m, spread_m);
    std::vector<LidarPoint> points;
    for (int i = 0; i < 700; ++i)
      points.push_back(at(coordinate(random), coordinate(random), coordinate(random) / 4));
    const Clusters expected = bruteForce(points, 0.6);
    EXPECT_GT(expected.size(), 1U);
    EXPECT_EQ(euclideanClusters(points, 0.6), expected);
  }
}

TEST(Clusters, PartitionDoesNotDependOnTheOrderOfPoints) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(-5.0, 5.0);
  std::vector<LidarPoint> points;
  for (int i = 0; i < 400; ++i) {
    points.push_back(at(coordinate(random), coordinate(random)));
    points.back().ring = static_cast<std::uint16_t>(i);  // its name
  }
  const auto partition = [](const std::vector<LidarPoint>& p) {
    std::vector<std::vector<int>> named;
    for (const auto& cluster : euclideanClusters(p, 0.4)) {
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
  EXPECT_TRUE(euclideanClusters({}, 0.5).empty());
  EXPECT_EQ(euclideanClusters({at(1, 2, 3)}, 0.5), Clusters({{0}}));
  EXPECT_EQ(euclideanClusters({at(std::numeric_limits<double>::quiet_NaN(), 0), at(1, 1)}, 0.5),
            Clusters({{1}}));
  EXPECT_THROW((void)euclideanClusters({}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
