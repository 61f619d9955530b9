// SPDX-License-Identifier: MIT
#include "atlas/fusion/object_stage.hpp"

#include <gtest/gtest.h>

#include "tracking_scene.hpp"

namespace atlas {
namespace {

Odometry pose(double t_s, double speed_mps) {
  Odometry odometry;
  odometry.stamp = at(t_s);
  odometry.T_map_imu.translation = {speed_mps * t_s, 0.0, 1.5};
  odometry.velocity_imu_mps.x() = speed_mps;
  return odometry;
}
Obstacles obstaclesAt(double t_s, const Vehicle& vehicle, double ego_x) {
  Obstacles obstacles;
  obstacles.stamp = at(t_s);
  obstacles.obstacles.push_back(seenPart(vehicle, {ego_x, 0.0}));
  return obstacles;
}
StaticTransforms radarInFront() {
  StaticTransforms transforms;
  transforms.transforms.push_back({"base_link", "imu", {}});
  transforms.transforms.push_back(
      {"base_link", "radar_ti", {Eigen::Quaterniond::Identity(), {1.0, 0.0, -0.5}}});
  return transforms;
}

class ObjectStageTest : public ::testing::Test {
 protected:
  void listen(ObjectStage& stage) {
    stage.on_objects = [this](const ObjectsPtr& objects) { answers_.push_back(objects); };
  }
  std::vector<ObjectsPtr> answers_;
};

TEST_F(ObjectStageTest, EveryObstaclesIsAnsweredOnceAtItsStamp) {
  ObjectStage stage{ObjectParams{}};
  listen(stage);
  for (int i = 0; i < 20; ++i) {
    stage.push(pose(0.1 * i - 0.001, 5.0));
    stage.push(obstaclesAt(0.1 * i, {20.0, 3.0}, 0.5 * i));
  }
  for (std::size_t input = 0; input < stage.inputs(); ++input) stage.finish(input);
  ASSERT_EQ(answers_.size(), 20U)
      << "sensors that never appear are not waited for once their streams have ended";
  for (int i = 0; i < 20; ++i) EXPECT_EQ(answers_[static_cast<std::size_t>(i)]->stamp, at(0.1 * i));
  ASSERT_EQ(answers_.back()->objects.size(), 1U);
  EXPECT_TRUE(answers_.back()->objects[0].is_static);
  EXPECT_TRUE(answers_.back()->T_map_imu.has_value());
  const Origin& source = answers_.back()->objects[0].sources.at(0);
  EXPECT_EQ(source.topic, "obstacles");
  EXPECT_EQ(source.stamp, at(1.9));
}

/// Targets with range rates of either sign convention: the approaching car gets its velocity.
TEST_F(ObjectStageTest, RadarVelocitiesOfEitherSign) {
  for (const double convention : {1.0, -1.0}) {
    answers_.clear();
    ObjectParams params;
    params.lidars.clear();
    ObjectStage stage(params);
    listen(stage);
    stage.push(0, radarInFront());
    for (int i = 0; i < 60; ++i) {
      const double t = 0.05 * i, ego = 8.0 * t;
      stage.push(pose(t - 0.001, 8.0));
      RadarScan scan;
      scan.stamp = at(t);
      scan.frame = "radar_ti";
      const Eigen::Vector3d radar(ego + 1.0, 0.0, 1.0);
      const auto target = [&](const Eigen::Vector3d& p, double vx) {
        const Eigen::Vector3d line = (p - radar).normalized();
        scan.targets.push_back({p - radar, convention * line.x() * (vx - 8.0)});
      };
      target({60.0, 6.0, 1.0}, 0.0);
      target({70.0, -6.0, 1.0}, 0.0);
      target({75.0 - 7.0 * t, 2.0, 1.0}, -7.0);
      stage.push(0, scan);
    }
    for (std::size_t input = 0; input < stage.inputs(); ++input) stage.finish(input);
    ASSERT_FALSE(answers_.empty());
    ASSERT_EQ(answers_.back()->objects.size(), 1U) << "what stands is left to sensors that see shapes";
    EXPECT_NEAR(answers_.back()->objects[0].velocity_mps.x(), -7.0, 0.6);
  }
}

TEST_F(ObjectStageTest, ScansThatCannotBePlacedAreCounted) {
  ObjectStage stage{ObjectParams{}};
  listen(stage);
  RadarScan scan;
  scan.frame = "elsewhere";
  scan.targets.resize(3);
  scan.stamp = at(0.0);
  stage.push(0, scan);
  stage.push(pose(0.5, 0.0));
  scan.stamp = at(0.55);
  stage.push(0, scan);
  scan.stamp = at(0.9);
  stage.push(0, scan);
  for (std::size_t input = 0; input < stage.inputs(); ++input) stage.finish(input);
  for (const Reason reason : {Reason::kNoPoseYet, Reason::kMissingFrame, Reason::kPoseGap})
    EXPECT_EQ(stage.counters().get(std::string("skipped radar scan: ") + toString(reason)), 1U)
        << toString(reason);
  EXPECT_TRUE(answers_.empty());
}

/// The order in which the inputs arrive has no influence.
TEST_F(ObjectStageTest, ArrivalOrderHasNoInfluence) {
  std::vector<double> found[2];
  for (int order = 0; order < 2; ++order) {
    answers_.clear();
    ObjectStage stage{ObjectParams{}};
    listen(stage);
    const auto odometry = [&] {
      for (int i = 0; i < 100; ++i) stage.push(pose(0.02 * i - 0.001, 5.0));
      stage.finish(ObjectStage::kOdometry);
    };
    const auto obstacles = [&] {
      for (int i = 0; i < 20; ++i) stage.push(obstaclesAt(0.1 * i, {20.0 + 4.0 * 0.1 * i, 3.0}, 0.5 * i));
      stage.finish(stage.obstaclesInput());
    };
    const auto frustums = [&] {
      for (int i = 0; i < 20; ++i) {
        Frustums f;
        f.stamp = at(0.1 * i + 0.03);
        f.frustums.push_back(frustumOf({17.8 + 0.4 * i, 3.0, 0.8}, {0.5 * i, 0.0, 1.5}, 1.9, 1.5, 2));
        stage.push(f);
      }
      stage.finish(stage.frustumsInput());
    };
    if (order == 0) {
      odometry();
      obstacles();
      frustums();
    } else {
      frustums();
      obstacles();
      odometry();
    }
    for (std::size_t input = 0; input < stage.inputs(); ++input) stage.finish(input);
    for (const ObjectsPtr& objects : answers_) {
      for (const Object& o : objects->objects)
        found[order].insert(found[order].end(),
                            {o.position.x(), o.position.y(), o.velocity_mps.x(), o.class_probability});
    }
  }
  ASSERT_GT(found[0].size(), 50U);
  EXPECT_EQ(found[0], found[1]);
}

}  // namespace
}  // namespace atlas
