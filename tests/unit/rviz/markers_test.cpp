// SPDX-License-Identifier: MIT
// What reaches the screen: every thing once, at its place, with its stamp; an empty answer clears the screen;
// RViz would accept it.
#include "markers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr atlas::Stamp kStamp = 1568186745408734467;
const double kNaN = std::numeric_limits<double>::quiet_NaN();

/// What RViz demands of an array: DELETEALL first and only there, names unique, quaternions and numbers
/// sound, colours complete.
void expectSound(const MarkerArray& array, const std::string& frame = "map") {
  ASSERT_FALSE(array.markers.empty());
  EXPECT_EQ(array.markers[0].action, Marker::DELETEALL);
  std::set<std::pair<std::string, int>> names;
  for (std::size_t i = 0; i < array.markers.size(); ++i) {
    const Marker& m = array.markers[i];
    EXPECT_EQ(m.header.stamp.toNSec(), static_cast<std::uint64_t>(kStamp));
    EXPECT_EQ(m.header.frame_id, frame);
    if (i == 0) continue;
    EXPECT_EQ(m.action, Marker::ADD);
    EXPECT_TRUE(names.emplace(m.ns, m.id).second) << m.ns << " " << m.id;
    const auto& q = m.pose.orientation;
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0, 1e-9);
    EXPECT_GT(m.color.a, 0.F);
    EXPECT_TRUE(m.colors.empty() || m.colors.size() == m.points.size());
    for (const auto& p : m.points)
      EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    if (m.type == Marker::LINE_LIST) {
      EXPECT_TRUE(!m.points.empty() && m.points.size() % 2 == 0);
    }
    if (m.type == Marker::CUBE) {
      EXPECT_TRUE(m.scale.x > 0 && m.scale.y > 0 && m.scale.z > 0);
    }
    if (m.type == Marker::TEXT_VIEW_FACING) {
      EXPECT_TRUE(m.scale.z > 0 && !m.text.empty());
    }
  }
}

const Marker* find(const MarkerArray& array, const std::string& ns, int id = 0) {
  for (const Marker& m : array.markers) {
    if (m.action == Marker::ADD && m.ns == ns && m.id == id) return &m;
  }
  return nullptr;
}

atlas::Frustum frustumOf(int class_id, double distance_m) {
  atlas::Frustum frustum;
  frustum.detection.class_id = class_id;
  frustum.distance_m = distance_m;
  for (std::size_t i = 0; i < 8; ++i) frustum.corners[i] = Eigen::Vector3d(distance_m, i % 4, i < 4 ? 0 : 5);
  return frustum;
}

TEST(Obstacles, ABoxWithItsSizeAtItsPlace) {
  atlas::Obstacles obstacles;
  obstacles.stamp = kStamp;
  obstacles.obstacles.push_back({{1, 2, 3}, M_PI / 2, {4.2, 1.8, 1.5}, 90});
  const MarkerArray array = atlas_rviz::obstacleMarkers(obstacles);
  expectSound(array);
  const Marker* box = find(array, "boxes");
  ASSERT_NE(box, nullptr);
  EXPECT_EQ(box->pose.position.x, 1);
  EXPECT_NEAR(box->pose.orientation.z, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(box->scale.x, 4.2);
  ASSERT_NE(find(array, "text"), nullptr);
  EXPECT_EQ(find(array, "text")->text, "4.2 x 1.8 x 1.5 m");
  EXPECT_GT(find(array, "text")->pose.position.z, 3 + 1.5 / 2);
  EXPECT_EQ(find(array, "edges")->points.size(), 24U);
}

TEST(Obstacles, AWallIsOnlyEdgesAndAFlatBoxIsSeen) {
  atlas::Obstacles obstacles;
  obstacles.stamp = kStamp;
  obstacles.obstacles.push_back({{0, 0, 0}, 0, {30, 1, 4}, 900});
  obstacles.obstacles.push_back({{9, 0, 0}, 0, {1, 0, 1}, 15});
  const MarkerArray array = atlas_rviz::obstacleMarkers(obstacles);
  expectSound(array);
  EXPECT_EQ(array.markers.size(), 4U);  // delete, one box, its text, edges of both
  EXPECT_EQ(find(array, "boxes")->pose.position.x, 9);
  EXPECT_EQ(find(array, "edges")->points.size(), 48U);
}

TEST(Lines, AColourForEachKindAndNothingForNaN) {
  atlas::Line wall, marking, broken;
  wall.to = {1, 2, 3};
  marking.kind = atlas::LineKind::kMarking;
  marking.from.x() = 9;
  broken.to.x() = kNaN;
  const MarkerArray array = atlas_rviz::lineMarkers({kStamp, "lidar_left", {wall, broken, marking}});
  expectSound(array);
  const Marker* list = find(array, "lines");
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->points.size(), 4U);
  ASSERT_EQ(list->colors.size(), 4U);
  EXPECT_EQ(list->points[1].y, 2);
  EXPECT_EQ(list->points[2].x, 9);
  EXPECT_NE(list->colors[0], list->colors[2]);
}

TEST(Obstacles, NothingFoundClearsTheScreen) {
  atlas::Obstacles obstacles;
  obstacles.stamp = kStamp;
  const MarkerArray array = atlas_rviz::obstacleMarkers(obstacles);
  expectSound(array);
  EXPECT_EQ(array.markers.size(), 1U);
}

TEST(Obstacles, OneBadNumberDoesNotHideTheOthers) {
  atlas::Obstacles obstacles;
  obstacles.stamp = kStamp;
  obstacles.obstacles.push_back({{kNaN, 2, 3}, 0, {1, 1, 1}, 9});
  obstacles.obstacles.push_back({{1, 2, 3}, kNaN, {1, 1, 1}, 9});
  obstacles.obstacles.push_back({{1, 2, 3}, 0, {1, 1, 1}, 9});
  const MarkerArray array = atlas_rviz::obstacleMarkers(obstacles);
  expectSound(array);
  EXPECT_EQ(find(array, "edges")->points.size(), 24U);
}

TEST(Frustums, ColouredByClassNamedWithDistance) {
  atlas::Frustums frustums;
  frustums.stamp = kStamp;
  frustums.frustums = {frustumOf(0, 7.04), frustumOf(2, 12.36)};
  const MarkerArray array = atlas_rviz::frustumMarkers(frustums);
  expectSound(array);
  EXPECT_EQ(find(array, "text", 0)->text, "person 7.0 m");
  EXPECT_EQ(find(array, "text", 1)->text, "car 12.4 m");
  EXPECT_EQ(find(array, "text", 0)->color.r, 1.F);
  EXPECT_LT(find(array, "text", 0)->color.b, 0.6F);
  const Marker* edges = find(array, "edges");
  ASSERT_EQ(edges->points.size(), 48U);
  for (std::size_t i = 0; i < 48; ++i) {
    const bool person = edges->points[i].x < 10;
    EXPECT_EQ(edges->colors[i].r > edges->colors[i].b, person) << i;  // red person, blue car
  }
}

TEST(Frustums, AnEmptyAnswerClearsTheScreenAndNaNIsLeftOut) {
  atlas::Frustums frustums;
  frustums.stamp = kStamp;
  expectSound(atlas_rviz::frustumMarkers(frustums));
  frustums.frustums = {frustumOf(0, 7)};
  frustums.frustums[0].corners[6].y() = kNaN;
  EXPECT_EQ(atlas_rviz::frustumMarkers(frustums).markers.size(), 1U);
}

TEST(Vehicle, TheBodyTurnsWithTheVehicle) {
  atlas::Odometry odometry;
  odometry.stamp = kStamp;
  odometry.T_map_imu = {Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())),
                        {100, 50, 2}};
  odometry.velocity_imu_mps = {3, 4, 0};
  const MarkerArray array = atlas_rviz::vehicleMarkers(odometry, {4.8, 1.8, 1.5, 1.3, -0.2});
  expectSound(array);
  const Marker* body = find(array, "body");
  EXPECT_NEAR(body->pose.position.x, 100, 1e-9);  // its middle is ahead, which is map y now
  EXPECT_NEAR(body->pose.position.y, 51.3, 1e-9);
  EXPECT_NEAR(body->pose.position.z, 1.8, 1e-9);
  EXPECT_EQ(find(array, "text")->text, "5.0 m/s, 18 km/h");
}

TEST(Vehicle, RefusesABodyWithoutSize) {
  EXPECT_NO_THROW(atlas_rviz::validate(atlas_rviz::VehicleBox{}));
  for (const double bad : {0.0, -1.0, kNaN}) {
    atlas_rviz::VehicleBox box;
    box.width_m = bad;
    try {
      atlas_rviz::validate(box);
      FAIL() << bad;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("vehicle_width_m"), std::string::npos);
    }
  }
}

TEST(Path, ALineFromTwoPointsOnRedderWhenFaster) {
  atlas_rviz::DrivenPath path;
  atlas::Odometry odometry;
  odometry.stamp = kStamp;
  path.add(odometry);
  expectSound(atlas_rviz::pathMarkers(path));
  EXPECT_EQ(atlas_rviz::pathMarkers(path).markers.size(), 1U);  // one point is no line
  odometry.T_map_imu.translation.x() = 5;
  odometry.velocity_imu_mps.x() = 25;  // faster than the end of the scale
  path.add(odometry);
  const MarkerArray array = atlas_rviz::pathMarkers(path);
  expectSound(array);
  const Marker* line = find(array, "path");
  ASSERT_EQ(line->points.size(), 2U);
  EXPECT_EQ(line->colors[0].b, 1.F);
  EXPECT_EQ(line->colors[0].r, 0.F);
  EXPECT_EQ(line->colors[1].r, 1.F);
  EXPECT_EQ(line->colors[1].b, 0.F);
}

TEST(Radar, TargetsStayInTheFrameOfTheRadar) {
  atlas::RadarScan scan;
  scan.stamp = kStamp;
  scan.frame = "radar_ti";
  expectSound(atlas_rviz::radarMarkers(scan), "radar_ti");
  scan.targets = {{{10, 0, 0}, -2.0}, {{kNaN, 0, 0}, 1.0}};
  const MarkerArray array = atlas_rviz::radarMarkers(scan);
  expectSound(array, "radar_ti");
  ASSERT_EQ(find(array, "targets")->points.size(), 1U);
  const Marker* speeds = find(array, "speeds");
  ASSERT_EQ(speeds->points.size(), 2U);
  EXPECT_EQ(speeds->points[1].x, 8.0);
}

TEST(Anchor, SaysWhereMapIs) {
  const MarkerArray array = atlas_rviz::anchorMarkers({kStamp, {49.2270512, 16.5722713, 287.24}});
  expectSound(array);
  EXPECT_EQ(find(array, "text")->text, "map: 49.227051 deg N, 16.572271 deg E, 287.2 m");
}

}  // namespace
