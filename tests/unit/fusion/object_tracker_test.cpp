// SPDX-License-Identifier: MIT
#include "atlas/fusion/object_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>

#include "tracking_scene.hpp"

namespace atlas {
namespace {

const auto kInView = [](const TrackShape&) { return 0.85; };

class TrackerTest : public ::testing::Test {
 protected:
  /// One lidar scan of the vehicles from `eye`.
  void look(double t_s, const std::vector<Vehicle>& vehicles, const Eigen::Vector2d& eye,
            std::function<double(const TrackShape&)> detectability = kInView) {
    Scan scan;
    scan.stamp = at(t_s);
    scan.input = "obstacles";
    for (const Vehicle& vehicle : vehicles) {
      Obstacle box = seenPart(vehicle, eye);
      shake(box, random_, 0.03);
      scan.measurements.push_back(seenBox(box, eye));
    }
    scan.detectability = std::move(detectability);
    tracker_.update(scan, counters_);
  }
  std::mt19937 random_{1};
  Counters counters_;
  ObjectTracker tracker_{TrackerParams{}};
};

TEST_F(TrackerTest, AParkedCarIsStaticWhenWeDriveBy) {
  const Vehicle parked{20.0, 3.0, 0.0, 4.4, 1.8, 1.5};
  int told = 0, dynamic = 0;
  for (double t = 0.0; t < 4.0; t += 0.1) {  // from 20 m behind to 20 m ahead of it
    look(t, {parked}, {10.0 * t, 0.0});
    for (const Object& object : tracker_.report(at(t)).objects) {
      ++told;
      dynamic += object.is_static ? 0 : 1;
      EXPECT_EQ(object.id, 1U);
      EXPECT_LT(object.velocity_mps.norm(), 1.0) << "at " << t << " s";
    }
  }
  EXPECT_GT(told, 35);
  EXPECT_LE(dynamic, 1);
  const Objects last = tracker_.report(at(4.0));
  ASSERT_EQ(last.objects.size(), 1U);
  EXPECT_NEAR(last.objects[0].position.x(), 20.0, 0.4);
  EXPECT_NEAR(last.objects[0].position.y(), 3.0, 0.4);
  EXPECT_NEAR(last.objects[0].size.x(), 4.4, 0.5);
  EXPECT_NEAR(std::remainder(last.objects[0].yaw_rad, M_PI), 0.0, 0.1);
}

TEST_F(TrackerTest, ACarPassingBehindABusKeepsItsId) {
  const Vehicle bus{15.0, 0.0, 0.0, 11.8, 2.5, 3.1};
  std::set<std::uint32_t> ids;
  bool was_hidden = false;
  for (double t = 0.0; t < 5.0; t += 0.1) {  // from the left of the bus to its right, at 10 m/s
    const Vehicle car{-5.0 + 10.0 * t, 12.0, 0.0, 4.4, 1.8, 1.5};
    const Eigen::Vector2d eye(15.0, -12.0);
    const bool hidden = std::abs(car.x - 15.0) < 9.0;
    was_hidden = was_hidden || hidden;
    look(t, hidden ? std::vector<Vehicle>{bus} : std::vector<Vehicle>{bus, car}, eye,
         [](const TrackShape& shape) {
           return shape.position().y() > 5.0 && std::abs(shape.position().x() - 15.0) < 9.0 ? 0.0 : 0.85;
         });
    for (const Object& object : tracker_.report(at(t)).objects) {
      if (object.position.y() < 5.0) continue;
      ids.insert(object.id);
