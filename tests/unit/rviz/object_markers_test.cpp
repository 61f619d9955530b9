// SPDX-License-Identifier: MIT
#include "object_markers.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "marker_shapes.hpp"

namespace atlas_rviz {
namespace {

atlas::Object car(std::uint32_t id, bool is_static) {
  atlas::Object o;
  o.id = id;
  o.class_id = 2;
  o.position = {10.0, 5.0, 0.75};
  o.size = {4.0, 2.0, 1.5};
  o.velocity_mps = {3.0, 4.0, 0.0};
  o.is_static = is_static;
  o.history.resize(3);
  for (std::size_t i = 0; i < 3; ++i) o.history[i].position.x() = static_cast<double>(i);
  return o;
}

const Marker* find(const MarkerArray& array, const std::string& ns, int id) {
  for (const Marker& m : array.markers) {
    if (m.ns == ns && m.id == id && m.action == Marker::ADD) return &m;
  }
  return nullptr;
}
std::string textOf(const MarkerArray& array) {
  std::string all;
  for (const Marker& m : array.markers) all += m.text + "|";
  return all;
}

TEST(ObjectMarkers, MovingOneHasAnArrowOfItsWayOfOneSecond) {
  atlas::Objects objects;
  objects.stamp = 42;
  objects.objects = {car(17, false)};
  const MarkerArray array = objectMarkers(objects);
  EXPECT_EQ(array.markers.front().action, Marker::DELETEALL);
  const Marker* arrow = find(array, "velocities", 17);
  ASSERT_NE(arrow, nullptr);
  EXPECT_DOUBLE_EQ(arrow->points[1].x, 13.0);
  EXPECT_DOUBLE_EQ(arrow->points[1].y, 9.0);
  EXPECT_NE(textOf(array).find("car 17, 5.0 m/s"), std::string::npos) << textOf(array);
  ASSERT_NE(find(array, "edges", 0), nullptr);
  EXPECT_EQ(find(array, "edges", 0)->points.size(), 24U);
  EXPECT_EQ(find(array, "trails", 0)->points.size(), 4U);
  EXPECT_EQ(array.markers.back().header.stamp.toNSec(), 42U);
}

TEST(ObjectMarkers, StandingOneHasNoneAndIsPale) {
  atlas::Objects objects;
  objects.objects = {car(3, true)};
  const MarkerArray array = objectMarkers(objects);
  EXPECT_EQ(find(array, "velocities", 3), nullptr);
  EXPECT_NE(textOf(array).find("|car 3|"), std::string::npos) << textOf(array);
  EXPECT_LT(find(array, "edges", 0)->colors.front().a, 1.0F);
}

TEST(ObjectMarkers, BadNumbersAreLeftOut) {
  atlas::Objects objects;
  objects.objects = {car(1, false), car(2, false)};
  objects.objects[0].velocity_mps.x() = std::numeric_limits<double>::quiet_NaN();
  objects.objects[1].history[1].position.y() = std::numeric_limits<double>::infinity();
  const MarkerArray array = objectMarkers(objects);
  EXPECT_EQ(find(array, "velocities", 1), nullptr);
  EXPECT_NE(find(array, "velocities", 2), nullptr);
  EXPECT_EQ(find(array, "trails", 0), nullptr);
  EXPECT_EQ(objectMarkers({}).markers.size(), 1U) << "what was shown before is deleted";
}

}  // namespace
}  // namespace atlas_rviz
