// SPDX-License-Identifier: MIT
#include "atlas/camera/thermal_stage.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "thermal_scene.hpp"

namespace atlas::test {
namespace {

std::vector<int> selected(const std::vector<ProjectedDetections>& answers) {
  std::vector<int> result;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i].detections.image_index, i);
    if (answers[i].selected) result.push_back(static_cast<int>(i));
  }
  return result;
}

TEST(ThermalStage, boxByHand) {
  ThermalStage stage(params());
  const auto result = answers(stage, {standing(), {ms(0)}, {{plateAt(ms(3), 2.0)}}});
  ASSERT_EQ(result.size(), 1U);
  EXPECT_TRUE(result[0].selected);
  EXPECT_EQ(result[0].detections.stamp, ms(0));
  EXPECT_EQ(result[0].source_stamps, std::vector<Stamp>{ms(3)});
  EXPECT_EQ(result[0].source_index, std::vector<std::uint32_t>{0});
  ASSERT_EQ(result[0].detections.boxes.size(), 1U);
  const Detection2d& box = result[0].detections.boxes[0];
  // 1..3 m left of the axis at 10 m, 100 px focal length, centre (50, 40)
  EXPECT_NEAR(box.x_min, 20.0, 1e-9);
  EXPECT_NEAR(box.x_max, 40.0, 1e-9);
  EXPECT_NEAR(box.y_min, 30.0, 1e-9);
  EXPECT_NEAR(box.y_max, 50.0, 1e-9);
}

// The published program takes the last frame received; the nearest may be the next one.
TEST(ThermalStage, nearestFrameOnBothSides) {
  const std::vector<Stamp> frames = {ms(0), ms(33), ms(66), ms(99)};
  const auto chosenBy = [&](Stamp rgb) {
    ThermalStage stage(params());
    return selected(answers(stage, {standing(), frames, {{plateAt(rgb)}}}));
  };
  EXPECT_EQ(chosenBy(ms(40)), std::vector<int>{1});               // before
  EXPECT_EQ(chosenBy(ms(60)), std::vector<int>{2});               // after
  EXPECT_EQ(chosenBy(ms(66)), std::vector<int>{2});               // equal
  EXPECT_EQ(chosenBy(kStart + 16'500'000), std::vector<int>{0});  // in the middle: the earlier
  EXPECT_EQ(chosenBy(kStart + 16'500'001), std::vector<int>{1});
  EXPECT_EQ(chosenBy(ms(-20)), std::vector<int>{0});  // before the first frame
  EXPECT_EQ(chosenBy(ms(149)), std::vector<int>{3});  // after the last, 50 ms is the limit
  EXPECT_EQ(chosenBy(ms(150)), std::vector<int>{});
  EXPECT_EQ(chosenBy(ms(-51)), std::vector<int>{});
}

TEST(ThermalStage, unmatchedFrustumsAreCounted) {
  ThermalStage stage(params());
  const auto result = answers(stage, {standing(), {ms(0)}, {{plateAt(ms(200))}}});
  ASSERT_EQ(result.size(), 1U);
  EXPECT_FALSE(result[0].selected);
  EXPECT_TRUE(result[0].detections.boxes.empty());
  EXPECT_EQ(stage.counters().get("skipped frustums: no thermal frame near in time"), 1U);
}

TEST(ThermalStage, twoImagesOfOneCameraDoNotLabelTwice) {
  ThermalStage stage(params());
  const auto result = answers(
      stage, {standing(), {ms(0), ms(100)}, {{plateAt(ms(-10)), plateAt(ms(4), 1.0), plateAt(ms(20))}}});
  EXPECT_EQ(result[0].source_stamps, std::vector<Stamp>{ms(4)});
  EXPECT_EQ(result[0].detections.boxes.size(), 1U);
  EXPECT_EQ(
      stage.counters().get("skipped frustums: another image of the camera is nearer to the thermal frame"),
      2U);
}

TEST(ThermalStage, camerasShareAFrame) {
  ThermalStage stage(params({"left", "right"}));
  const auto result = answers(stage, {standing(), {ms(0)}, {{plateAt(ms(2), 2.0)}, {plateAt(ms(-2), -2.0)}}});
  EXPECT_EQ(result[0].source_stamps.size(), 2U);
  EXPECT_EQ(result[0].detections.boxes.size(), 2U);
}

// The pose is that of the thermal frame, not of the RGB image: at 20 m/s the 30 ms between them are 0.6 m.
TEST(ThermalStage, W6_usesThePoseOfTheThermalFrame) {
  Inputs inputs{{}, {ms(30)}, {{plateAt(ms(0), 0.0, 10.6)}}};
  for (int i = -10; i <= 20; ++i) inputs.odometry.push_back(odometry(ms(i * 10), {0.2 * i, 0, 0}));
  ThermalStage stage(params());
  const Detection2d box = answers(stage, inputs)[0].detections.boxes.at(0);
  EXPECT_NEAR(box.x_max - box.x_min, 100.0 * 2.0 / 10.0, 1e-9);
}

TEST(ThermalStage, lostBoxesAndMissingDataAreCounted) {
  {
    ThermalStage stage(params());
    const auto result = answers(stage, {standing(), {ms(0)}, {{plateAt(ms(0), 0.0, -10.0)}}});
    EXPECT_TRUE(result[0].selected);
    EXPECT_TRUE(result[0].detections.boxes.empty());
    EXPECT_EQ(stage.counters().get("skipped thermal box: behind the thermal camera"), 1U);
  }
  {
    ThermalStage stage(params());
    const auto result = answers(stage, {{}, {ms(0)}, {{plateAt(ms(0))}}});
    EXPECT_TRUE(result[0].selected);
    EXPECT_TRUE(result[0].detections.boxes.empty());
    EXPECT_EQ(stage.counters().get("skipped thermal box: no pose yet"), 1U);
  }
}

TEST(ThermalStage, everyFrameIsAnsweredOnceInOrder) {
  Inputs inputs{standing(), {}, {{}}};
  for (int i = 0; i < 25; ++i) inputs.frames.push_back(ms(i * 33));
  for (int i = 0; i < 8; ++i) inputs.frustums[0].push_back(plateAt(ms(i * 100 + 12)));
  ThermalStage stage(params());
  const auto result = answers(stage, inputs);
  ASSERT_EQ(result.size(), 25U);
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result[i].detections.stamp, inputs.frames[i]);
  EXPECT_EQ(selected(result), (std::vector<int>{0, 3, 6, 9, 12, 16, 19, 22}));
}

TEST(ThermalStage, arrivalOrderHasNoInfluence) {
  Inputs inputs{{}, {}, {{}, {}}};
  for (int i = 0; i < 60; ++i) inputs.odometry.push_back(odometry(ms(i * 10), {0.1 * i, 0, 0}));
  for (int i = 0; i < 20; ++i) inputs.frames.push_back(ms(i * 33 + (i % 3) * 5));
  for (int i = 0; i < 6; ++i) inputs.frustums[0].push_back(plateAt(ms(i * 100 + 7), 1.0, 20.0));
  for (int i = 0; i < 12; ++i) inputs.frustums[1].push_back(plateAt(ms(i * 50), -1.0, 20.0));
  const auto text = [&](unsigned seed) {
    ThermalStage stage(params({"left", "right"}));
    std::ostringstream out;
    out.precision(17);
    for (const ProjectedDetections& p : answers(stage, inputs, seed)) {
      out << p.detections.stamp << " " << p.detections.image_index << " " << p.selected;
      for (const Stamp stamp : p.source_stamps) out << " " << stamp;
      for (const Detection2d& b : p.detections.boxes) out << " " << b.x_min << " " << b.y_max;
      out << "\n";
    }
    for (const auto& [key, count] : stage.counters().all()) out << key << " " << count << "\n";
    return out.str();
  };
  const std::string first = text(0);
  for (unsigned seed = 1; seed < 40; ++seed) EXPECT_EQ(text(seed), first) << seed;
}

TEST(ThermalStage, answersAsSoonAsNoImageCanChooseTheFrame) {
  ThermalStage stage(params());
  std::size_t count = 0;
  stage.on_projected = [&](const ProjectedDetections&) { ++count; };
  stage.push(0, rig({{"camera", forwardCamera()}}));
  stage.finish(ThermalStage::kTfStatic);
  for (const Odometry& o : standing()) stage.push(o);
  stage.pushThermal(simpleInfo("camera", ms(0)));
  stage.pushThermal(simpleInfo("camera", ms(30)));
  stage.advance(ThermalStage::kThermalInfo, ms(30));
  stage.advance(ThermalStage::kOdometry, ms(900));
  stage.advance(ThermalStage::kFirstCamera, ms(14));
  EXPECT_EQ(count, 0U);
  EXPECT_LT(stage.progress(), ms(0));
  stage.advance(ThermalStage::kFirstCamera, ms(30));  // 16..30 ms choose the second frame
  EXPECT_EQ(count, 1U);
  EXPECT_GE(stage.progress(), ms(0));
  stage.advance(ThermalStage::kThermalInfo, ms(200));
  stage.advance(ThermalStage::kFirstCamera, ms(79));
  EXPECT_EQ(count, 1U);
  stage.advance(ThermalStage::kFirstCamera, ms(80));  // max_time_difference after it
  EXPECT_EQ(count, 2U);
}

TEST(ThermalStage, refusesBadParameters) {
  ThermalParams p = params();
  p.min_visible_fraction = 1.5;
  EXPECT_THROW(ThermalStage{p}, std::invalid_argument);
  p = params();
  p.max_time_difference_s = -0.1;
  EXPECT_THROW(ThermalStage{p}, std::invalid_argument);
  p = params({});
  EXPECT_THROW(validate(p), std::invalid_argument);
  p = params();
  p.max_hidden_fraction = -0.1;
  EXPECT_THROW(validate(p), std::invalid_argument);
  p = params();
  p.bridged_confidence = 2.0;
  EXPECT_THROW(validate(p), std::invalid_argument);
  p = params();
  p.neighbour_s = -1.0;
  EXPECT_THROW(validate(p), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
