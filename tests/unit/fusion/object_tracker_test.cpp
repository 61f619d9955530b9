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

TEST_F(TrackerTest, ACarThatTurnsOutToBeAnotherBoxIsStillOneObject) {
  const Eigen::Vector2d eye(0.0, 0.0);
  for (double t = 0.0; t < 2.0;
       t += 0.1) {  // at first only a corner, with the hedge behind it: across the car
    const bool far = t < 0.95;
    look(t, {far ? Vehicle{20.0, 5.0, 0.5 * M_PI, 4.0, 1.6, 1.5} : Vehicle{20.0, 4.0, 0.0, 4.4, 1.8, 1.5}},
         eye);
    const Objects told = tracker_.report(at(t));
    EXPECT_LE(told.objects.size(), 1U) << "at " << t << " s";
  }
  const Objects last = tracker_.report(at(2.0));
  ASSERT_EQ(last.objects.size(), 1U);
  EXPECT_EQ(last.objects[0].id, 1U);
  EXPECT_NEAR(std::remainder(last.objects[0].yaw_rad, M_PI), 0.0, 0.15);
  EXPECT_NEAR(last.objects[0].position.y(), 4.0, 0.5);
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
      EXPECT_NEAR(object.position.x(), car.x, 2.5) << "at " << t << " s, hidden: " << hidden;
    }
  }
  EXPECT_TRUE(was_hidden);
  EXPECT_EQ(ids.size(), 1U);
  EXPECT_EQ(tracker_.report(at(5.0)).objects.size(), 2U);
}

TEST_F(TrackerTest, WhatLeftWithoutBeingHiddenIsDropped) {
  for (double t = 0.0; t < 2.0; t += 0.1) look(t, {Vehicle{10.0, 5.0}}, {0.0, 0.0});
  EXPECT_EQ(tracker_.report(at(2.0)).objects.size(), 1U);
  for (double t = 2.1; t < 3.0; t += 0.1) look(t, {}, {0.0, 0.0});
  EXPECT_TRUE(tracker_.report(at(3.0)).objects.empty());
}

TEST_F(TrackerTest, TwoCamerasSeeingOneObjectMakeOneObject) {
  const Vehicle car{15.0, 0.0};
  for (double t = 0.0; t < 1.0; t += 0.1) {
    look(t, {car}, {0.0, 0.0});
    for (const double eye_y : {-0.5, 0.5}) {
      Scan scan;
      scan.stamp = at(t + 0.02);
      scan.input = "frustums";
      scan.measurements.push_back(
          std::make_unique<FrustumMeasurement>(frustumOf({12.8, 0.0, 0.75}, {0.0, eye_y, 1.5}, 1.8, 1.5, 2)));
      tracker_.update(scan, counters_);
    }
  }
  const Objects objects = tracker_.report(at(1.0));
  ASSERT_EQ(objects.objects.size(), 1U);
  EXPECT_EQ(objects.objects[0].class_id, 2);
  EXPECT_GT(objects.objects[0].class_probability, 0.9);
  EXPECT_GE(objects.objects[0].sources.size(), 1U);
}

TEST_F(TrackerTest, ReversingDoesNotFlipHeadings) {
  int told = 0;
  for (double t = 0.0; t < 6.0; t += 0.1) {  // forward for 3 s, then back, beside a car that drives on
    const double ego = t < 3.0 ? 5.0 * t : 30.0 - 5.0 * t;
    look(t, {Vehicle{6.0 + 6.0 * t, 4.0, 0.0}, Vehicle{10.0, -4.0, 0.0}}, {ego, 0.0});
    for (const Object& object : tracker_.report(at(t)).objects) {
      if (object.position.y() < 0.0 || t < 1.5) continue;
      ++told;
      EXPECT_NEAR(object.yaw_rad, 0.0, 0.2) << "at " << t << " s";
      EXPECT_TRUE(object.heading_known);
    }
  }
  EXPECT_GE(told, 44);
}

TEST_F(TrackerTest, W19_NothingInheritsAnIdFromFarAway) {
  for (double t = 0.0; t < 0.95; t += 0.1) look(t, {Vehicle{10.0, 0.0}}, {0.0, 0.0});
  const std::uint32_t id = tracker_.report(at(0.9)).objects.at(0).id;
  for (double t = 1.0; t < 2.0; t += 0.1) look(t, {Vehicle{35.0, 0.0}}, {0.0, 0.0});
  for (const Object& object : tracker_.report(at(2.0)).objects) EXPECT_NE(object.id, id);
}

TEST_F(TrackerTest, W19_OneObjectLostDoesNotSwapTheOthers) {  // ids go by place, not by order
  for (double t = 0.0; t < 2.0; t += 0.1) {
    std::vector<Vehicle> cars;
    for (int i = 0; i < 4; ++i) {
      if (i == 1 && t > 1.0) continue;
      cars.push_back({10.0 + 8.0 * i, 5.0});
    }
    look(t, cars, {3.0 * t, 0.0});
  }
  for (const Object& object : tracker_.report(at(2.0)).objects)
    EXPECT_NEAR(object.position.x(), 10.0 + 8.0 * (object.id - 1.0), 0.6) << "id " << object.id;
}

TEST_F(TrackerTest, BadInputIsCountedAndHarmless) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 10; ++i) {
    Scan scan;
    scan.stamp = at(0.1 * i);
    scan.input = "obstacles";
    scan.measurements.push_back(seenBox(seenPart({10.0, 3.0}, {0.0, 0.0}), {0.0, 0.0}));
    scan.measurements.push_back(seenBox({{nan, 0.0, 0.0}, 0.0, {1.0, 1.0, 1.0}, 9}, {0.0, 0.0}));
    scan.measurements.push_back(seenBox({{5.0, 0.0, 0.0}, 0.0, {-1.0, 1.0, 1.0}, 9}, {0.0, 0.0}));
    scan.measurements.push_back(seenBox({{5.0, 0.0, 0.0}, nan, {1.0, 1.0, 1.0}, 9}, {0.0, 0.0}));
    tracker_.update(scan, counters_);
  }
  EXPECT_EQ(tracker_.report(at(1.0)).objects.size(), 1U);
  EXPECT_EQ(counters_.get("skipped obstacles: " + std::string(toString(Reason::kNotFinite))), 20U);
  EXPECT_EQ(counters_.get("skipped obstacles: " + std::string(toString(Reason::kBadLayout))), 10U);
  Scan late;
  late.stamp = at(0.0);
  late.input = "obstacles";
  tracker_.update(late, counters_);
  EXPECT_EQ(counters_.get("skipped obstacles: " + std::string(toString(Reason::kOutOfOrder))), 1U);
}

TEST_F(TrackerTest, TenThousandBoxesInAScan) {
  std::uniform_real_distribution<double> place(-20.0, 20.0);
  for (int k = 0; k < 3; ++k) {
    Scan scan;
    scan.stamp = at(0.1 * k);
    scan.input = "obstacles";
    for (int i = 0; i < 10000; ++i) {
      const Obstacle box{{place(random_), place(random_), 0.5}, 0.0, {0.5, 0.5, 1.0}, 9};
      scan.measurements.push_back(seenBox(box, {0.0, 0.0}));
    }
    tracker_.update(scan, counters_);
  }
  EXPECT_LE(tracker_.tracks().size(), 1000U);
  EXPECT_GT(counters_.get("tracks not begun: max_tracks"), 0U);
}

/// Any order of the boxes of a scan gives the same bits.
TEST(Tracker, OrderOfMeasurementsHasNoInfluence) {
  std::vector<double> found[2];
  for (int order = 0; order < 2; ++order) {
    std::mt19937 random(4), shuffle(9);
    Counters counters;
    ObjectTracker tracker{TrackerParams{}};
    for (double t = 0.0; t < 2.0; t += 0.1) {
      std::vector<Obstacle> boxes;
      for (int i = 0; i < 20; ++i) {
        Obstacle box = seenPart({2.0 * i + 5.0 * t, 4.0 + (i % 3), 0.1 * i}, {0.0, 0.0});
        shake(box, random, 0.1);
        boxes.push_back(box);
      }
      if (order == 1) std::shuffle(boxes.begin(), boxes.end(), shuffle);
      Scan scan;
      scan.stamp = at(t);
      scan.input = "obstacles";
      scan.detectability = kInView;
      for (const Obstacle& box : boxes) scan.measurements.push_back(seenBox(box, {0.0, 0.0}));
      tracker.update(scan, counters);
      for (const Object& o : tracker.report(at(t)).objects)
        found[order].insert(found[order].end(),
                            {static_cast<double>(o.id), o.position.x(), o.position.y(), o.yaw_rad,
                             o.velocity_mps.x(), o.existence, o.static_probability});
    }
  }
  ASSERT_GT(found[0].size(), 500U);
  ASSERT_EQ(found[0].size(), found[1].size());
  EXPECT_EQ(std::memcmp(found[0].data(), found[1].data(), found[0].size() * sizeof(double)), 0);
}

TEST(Tracker, AnotherCostIsOneFunction) {
  Counters counters;
  ObjectTracker tracker(TrackerParams{},
                        [](const TrackShape&, const Measurement&, double) { return std::nullopt; });
  for (double t = 0.0; t < 0.5; t += 0.1) {
    Scan scan;
    scan.stamp = at(t);
    scan.measurements.push_back(seenBox(seenPart({10.0, 3.0}, {0.0, 0.0}), {0.0, 0.0}));
    tracker.update(scan, counters);
  }
  EXPECT_TRUE(tracker.report(at(0.5)).objects.empty()) << "nothing belongs to anything: nothing is confirmed";
}

TEST(Tracker, RefusesParametersThatMakeNoSense) {
  const auto refused = [](auto change) {
    TrackerParams params;
    change(params);
    EXPECT_THROW(ObjectTracker{params}, std::invalid_argument);
  };
  refused([](TrackerParams& p) { p.confirm_existence = 1.0; });
  refused([](TrackerParams& p) { p.tell_existence = 0.01; });
  refused([](TrackerParams& p) { p.gate_sigmas = 0.0; });
  refused([](TrackerParams& p) { p.max_tracks = 0; });
  refused([](TrackerParams& p) { p.history = -1; });
  refused([](TrackerParams& p) { p.static_probability = std::numeric_limits<double>::quiet_NaN(); });
}

}  // namespace
}  // namespace atlas
