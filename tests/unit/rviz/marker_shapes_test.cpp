// SPDX-License-Identifier: MIT
// Corners and edges of boxes and frustums: twelve different edges, each of a length of the box, where the
// pose says.
#include "marker_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace {

Eigen::Vector3d toEigen(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }

TEST(BoxCorners, LengthLiesAlongYaw) {
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  const auto corners = atlas_rviz::boxCorners({quarter, {10, 20, 30}}, {4, 2, 1});
  Eigen::Vector3d low = corners[0], high = corners[0];
  for (const auto& p : corners) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  EXPECT_LT((low - Eigen::Vector3d(9, 18, 29.5)).norm(), 1e-12);  // length 4 along map y
  EXPECT_LT((high - Eigen::Vector3d(11, 22, 30.5)).norm(), 1e-12);
}

TEST(AddEdges, TwelveEdgesOfTheBoxAndNoDiagonal) {
  const auto corners = atlas_rviz::boxCorners({}, {4, 2, 1});
  atlas_rviz::Marker lines;
  atlas_rviz::addEdges(lines, corners, atlas_rviz::color(1, 0, 0));
  ASSERT_EQ(lines.points.size(), 24U);
  ASSERT_EQ(lines.colors.size(), 24U);
  std::map<double, int> lengths;
  std::set<std::pair<int, int>> edges;
  const auto cornerOf = [&](const geometry_msgs::Point& p) {
    for (int i = 0; i < 8; ++i) {
      if (toEigen(p) == corners[i]) return i;
    }
    return -1;
  };
  for (std::size_t i = 0; i < 24; i += 2) {
    ++lengths[(toEigen(lines.points[i]) - toEigen(lines.points[i + 1])).norm()];
    const int a = cornerOf(lines.points[i]), b = cornerOf(lines.points[i + 1]);
    edges.emplace(std::min(a, b), std::max(a, b));
  }
  EXPECT_EQ(lengths, (std::map<double, int>{{1.0, 4}, {2.0, 4}, {4.0, 4}}));
  EXPECT_EQ(edges.size(), 12U);
}

TEST(EmptyArray, DeletesInTheFrameAtTheStampOfTheData) {
  const auto array = atlas_rviz::emptyArray({1568186745408734467, "radar_ti"});
  ASSERT_EQ(array.markers.size(), 1U);
  EXPECT_EQ(array.markers[0].action, atlas_rviz::Marker::DELETEALL);
  EXPECT_EQ(array.markers[0].header.frame_id, "radar_ti");
  EXPECT_EQ(array.markers[0].header.stamp.sec, 1568186745U);
  EXPECT_EQ(array.markers[0].header.stamp.nsec, 408734467U);
}

}  // namespace
