// SPDX-License-Identifier: MIT
// What the thermal stage learns from the images before and after an image, and from the lidar.
#include <gtest/gtest.h>

#include "atlas/camera/thermal_stage.hpp"
#include "thermal_scene.hpp"

namespace atlas::test {
namespace {

Frustums nothingAt(Stamp stamp) {
  Frustums result;
  result.stamp = stamp;
  return result;
}

// 10 m/s to the right, seen 30 ms before the thermal frame: 0.3 m are 3 px at 10 m.
TEST(ThermalMotion, anObjectIsWhereItHasMovedTo) {
  ThermalStage stage(params());
  const auto result = answers(
      stage, {standing(), {ms(130)}, {{plateAt(ms(0), 1.0), plateAt(ms(100), 0.0), plateAt(ms(200), -1.0)}}});
  ASSERT_EQ(result[0].detections.boxes.size(), 1U);
  EXPECT_NEAR(result[0].detections.boxes[0].x_min, 43.0, 1e-9);
  EXPECT_NEAR(result[0].detections.boxes[0].x_max, 63.0, 1e-9);
}

// One detection in twenty is missing; the object does not leave the picture for that.
TEST(ThermalMotion, anObjectMissedInOneImageIsLabelled) {
  ThermalStage stage(params());
  const auto result = answers(
      stage, {standing(), {ms(100)}, {{plateAt(ms(0), 0.2), nothingAt(ms(95)), plateAt(ms(200), -0.2)}}});
  EXPECT_EQ(result[0].source_stamps, std::vector<Stamp>{ms(95)});
  ASSERT_EQ(result[0].detections.boxes.size(), 1U);
  EXPECT_NEAR(result[0].detections.boxes[0].x_min, 40.0, 1e-9);
  EXPECT_EQ(result[0].source_index, std::vector<std::uint32_t>{kBridged});
  EXPECT_EQ(stage.counters().get("thermal boxes bridged"), 1U);
}

TEST(ThermalMotion, onlyOneMissingImageIsBridged) {
  const std::vector<Frustums> two_missed = {plateAt(ms(0)), nothingAt(ms(100)), nothingAt(ms(200)),
                                            plateAt(ms(300))};
  const std::vector<Frustums> long_gap = {plateAt(ms(0)), nothingAt(ms(160)), plateAt(ms(260))};
  for (const auto& images : {two_missed, long_gap}) {
    ThermalStage stage(params());
    for (const auto& p : answers(stage, {standing(), {ms(100), ms(160), ms(200)}, {images}}))
      EXPECT_TRUE(p.detections.boxes.empty());
  }
  ThermalParams alone = params();
  alone.neighbour_s = 0.0;
  ThermalStage stage(alone);
  const std::vector<Frustums> one_missed = {plateAt(ms(0)), nothingAt(ms(100)), plateAt(ms(200))};
  EXPECT_TRUE(answers(stage, {standing(), {ms(100)}, {one_missed}})[0].detections.boxes.empty());
}

// The image before is of the same camera, however the images of the cameras follow each other.
TEST(ThermalMotion, neighboursAreOfTheSameCamera) {
  ThermalStage stage(params({"left", "right"}));
  const std::vector<Frustums> left = {plateAt(ms(0)), nothingAt(ms(100)), nothingAt(ms(200))};
  const std::vector<Frustums> right = {nothingAt(ms(10)), nothingAt(ms(110)), plateAt(ms(210))};
  const auto result = answers(stage, {standing(), {ms(105)}, {left, right}});
  EXPECT_EQ(result[0].source_stamps.size(), 2U);
  EXPECT_TRUE(result[0].detections.boxes.empty());
}

TEST(ThermalMotion, theNextImageIsNotWaitedForForEver) {
  ThermalStage stage(params());
  std::size_t count = 0;
  stage.on_projected = [&](const ProjectedDetections&) { ++count; };
  stage.finish(ThermalStage::kTfStatic);
  for (const Odometry& o : standing()) stage.push(o);
  stage.advance(ThermalStage::kOdometry, ms(900));
  stage.pushThermal(simpleInfo("camera", ms(0)));
  stage.advance(ThermalStage::kThermalInfo, ms(900));
  stage.push(0, plateAt(ms(0)));
  stage.advance(ThermalStage::kFirstCamera, ms(149));
  EXPECT_EQ(count, 0U);
  EXPECT_LT(stage.progress(), ms(0));
  stage.advance(ThermalStage::kFirstCamera, ms(150));
  EXPECT_EQ(count, 1U);
  EXPECT_GE(stage.progress(), ms(0));
}

// The plate is 2 m wide at 10 m; a wall at 5 m hides all of it.
TEST(ThermalMotion, anObjectBehindSomethingNearerIsNotLabelled) {
  const auto boxes = [](double distance, Stamp measured) {
    ThermalParams with_lidar = params();
    with_lidar.lidars = {"lidar"};
    ThermalStage stage(with_lidar);
    const auto result = answers(
        stage,
        {standing(), {ms(100)}, {{plateAt(ms(100))}}, {sweepOf(wall(distance, 2.0, 2.0, 0.05), measured)}});
    const std::size_t dropped = stage.counters().get("skipped thermal box: hidden by something nearer");
    EXPECT_EQ(result[0].detections.boxes.size() + dropped, 1U);
    return result[0].detections.boxes.size();
  };
  EXPECT_EQ(boxes(5.0, ms(100)), 0U);
  EXPECT_EQ(boxes(10.0, ms(100)), 1U) << "the plate itself";
  EXPECT_EQ(boxes(15.0, ms(100)), 1U) << "something behind it";
  EXPECT_EQ(boxes(5.0, ms(150)), 0U) << "the sweep that was under way is waited for";
  EXPECT_EQ(boxes(5.0, ms(40)), 1U) << "it may have moved away since";
}

}  // namespace
}  // namespace atlas::test
