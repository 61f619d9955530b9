// SPDX-License-Identifier: MIT
#include "atlas/camera/camera_lidar_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "scene.hpp"

namespace atlas::test {
namespace {

CameraLidarParams params() {
  CameraLidarParams p;
  p.cameras = {"camera"};
  p.lidars = {"lidar"};
  p.look_ahead_s = 0.0;
  return p;
}

struct Inputs {
  std::vector<Odometry> odometry = {test::odometry(kStart - kMillisecond),
                                    test::odometry(kStart + kMillisecond)};
  std::vector<BatchedSweepPtr> sweeps = {sweepOf(wall(20.0, 12.0, 9.0, 0.1), kStart - kMillisecond)};
  std::vector<CameraInfo> infos = {simpleInfo("camera", kStart)};
  std::vector<Detections> detections;
};

Detections detectionsOf(std::vector<Detection2d> boxes, Stamp stamp = kStart, std::uint32_t index = 0) {
  Detections d;
  d.stamp = stamp;
  d.frame = "camera";
  d.image_index = index;
  d.boxes = std::move(boxes);
  return d;
}
Detection2d car(double x_min, double y_min, double x_max, double y_max) {
  return {x_min, y_min, x_max, y_max, 2, 0.9};
}

std::vector<Frustums> answers(CameraLidarStage& stage, const Inputs& inputs, unsigned seed = 0) {
  std::vector<Frustums> result;
  stage.on_frustums = [&](std::size_t, const Frustums& f) { result.push_back(f); };
  std::vector<Feed> feeds(5);
  feeds[0] = {CameraLidarStage::kTfStatic, {[&] { stage.push(0, rig({{"camera", forwardCamera()}})); }}};
  feeds[1].input = CameraLidarStage::kOdometry;
  for (const Odometry& o : inputs.odometry) feeds[1].pushes.push_back([&] { stage.push(o); });
  feeds[2].input = stage.lidarInput(0);
  for (const auto& sweep : inputs.sweeps) feeds[2].pushes.push_back([&] { stage.push(0, sweep); });
  feeds[3].input = stage.cameraInfoInput(0);
  for (const auto& info : inputs.infos) feeds[3].pushes.push_back([&] { stage.push(0, info); });
  feeds[4].input = stage.detectionsInput(0);
  for (const auto& d : inputs.detections) feeds[4].pushes.push_back([&] { stage.push(0, d); });
  run(stage, feeds, seed);
  EXPECT_TRUE(stage.ended());
  return result;
}

TEST(CameraLidarStage, distanceOfTheWallByHand) {
  Inputs inputs;
  inputs.detections = {detectionsOf({car(60, 30, 80, 50)}, kStart, 12)};
  CameraLidarStage stage(params());
  const auto result = answers(stage, inputs);
  ASSERT_EQ(result.size(), 1U);
  EXPECT_EQ(result[0].stamp, kStart);
  EXPECT_EQ(result[0].camera, "camera");
  EXPECT_EQ(result[0].image_index, 12U);
  ASSERT_EQ(result[0].frustums.size(), 1U);
  const Frustum& f = result[0].frustums[0];
  EXPECT_NEAR(f.distance_m, 20.0, 1e-5);
  // Box centre (70, 40): 20 px right of the axis = 4 m at 20 m; right is -y.
  EXPECT_TRUE(f.position.isApprox(Eigen::Vector3d(20, -4, 0), 1e-5)) << f.position.transpose();
  EXPECT_NEAR(f.range_m, std::sqrt(400.0 + 16.0), 1e-5);
  EXPECT_EQ(f.detection.class_id, 2);
  // 4 m x 4 m with a point every 0.1 m; those on the box's edge do not count.
  EXPECT_NEAR(f.points, 39.0 * 39.0, 80.0);
  EXPECT_GT(f.depth_sigma_m, 0.01);
}

// W13 through the whole stage, with the real lens: an object at the image's border keeps its distance.
TEST(CameraLidarStage, W13_objectAtTheImageBorderStaysAtItsDistance) {
  Inputs inputs;
  inputs.infos = {leftFrontInfo(kStart)};
  inputs.infos[0].frame = "camera";
  inputs.sweeps = {sweepOf(wall(20.0, 20.0, 12.0, 0.1))};
  inputs.detections = {detectionsOf({car(0, 400, 100, 700), car(1820, 400, 1920, 700), car(0, 0, 100, 90)})};
  CameraLidarStage stage(params());
  const auto result = answers(stage, inputs);
  ASSERT_EQ(result[0].frustums.size(), 3U);
  for (const Frustum& f : result[0].frustums) {
    EXPECT_NEAR(f.distance_m, 20.0, 1e-4);
    EXPECT_NEAR(f.position.x(), 20.0, 1e-4);
    EXPECT_GT(std::abs(f.position.y()), 11.0);
    EXPECT_GT(f.range_m, 22.5);
  }
}

// The pose is the one at the image's own stamp, between two poses: at 20 m/s the last one would be 8 cm
// behind, the last GNSS pose of the published program up to 1 m.
TEST(CameraLidarStage, W6_usesThePoseOfTheImage) {
  const Stamp image = kStart + 104 * kMillisecond;
  Inputs inputs;
  inputs.odometry.clear();
  for (int i = 0; i <= 20; ++i)
    inputs.odometry.push_back(test::odometry(kStart + i * 10 * kMillisecond, {0.2 * i, 0, 0}));
  inputs.sweeps = {sweepOf(wall(30.0, 12.0, 9.0, 0.1), kStart)};
  inputs.infos = {simpleInfo("camera", image)};
  inputs.detections = {detectionsOf({car(40, 30, 60, 50)}, image)};
  CameraLidarStage stage(params());
  const auto result = answers(stage, inputs);
  ASSERT_EQ(result[0].frustums.size(), 1U);
  EXPECT_NEAR(result[0].frustums[0].distance_m, 30.0 - 2.08, 1e-4);
  EXPECT_NEAR(result[0].frustums[0].position.x(), 30.0, 1e-4) << "the wall stands still in map";
}

TEST(CameraLidarStage, everyDetectionWithoutFrustumHasAReason) {
  Inputs inputs;
  inputs.sweeps = {sweepOf({point(20, 0, 0), point(20, 0.1, 0)})};
  inputs.detections = {detectionsOf(
      {car(40, 30, 60, 50), car(0, 0, 10, 10), car(200, 0, 220, 10), car(std::nan(""), 0, 10, 10)})};
  CameraLidarStage stage(params());
  const auto result = answers(stage, inputs);
  ASSERT_EQ(result.size(), 1U);
  EXPECT_TRUE(result[0].frustums.empty());
  EXPECT_EQ(stage.counters().get("skipped detection: below the quality limit"), 1U);  // 2 points, 3 needed
  EXPECT_EQ(stage.counters().get("skipped detection: no points"), 1U);
  EXPECT_EQ(stage.counters().get("skipped detection: empty"), 1U);
  EXPECT_EQ(stage.counters().get("skipped detection: not finite"), 1U);
  EXPECT_EQ(stage.counters().get("detections"), 4U);
}

TEST(CameraLidarStage, missingCameraInfoPoseOrSweepsAreCounted) {
  const auto check = [](const std::function<void(Inputs&)>& change, const std::string& counter) {
    Inputs inputs;
    inputs.detections = {detectionsOf({car(40, 30, 60, 50), car(60, 30, 80, 50)})};
    change(inputs);
    CameraLidarStage stage(params());
    const auto result = answers(stage, inputs);
    ASSERT_EQ(result.size(), 1U) << counter;
    EXPECT_TRUE(result[0].frustums.empty());
    EXPECT_EQ(stage.counters().get(counter), 2U) << counter;
  };
  check([](Inputs& i) { i.infos.clear(); }, "skipped detection: camera_info missing or zero");
  check([](Inputs& i) { i.infos[0].stamp = kStart + 1; }, "skipped detection: camera_info missing or zero");
  check([](Inputs& i) { i.infos[0].K = {}; }, "skipped detection: camera_info missing or zero");
  check([](Inputs& i) { i.infos[0].frame = "other"; },
        "skipped detection: no extrinsic calibration for the frame");
  check([](Inputs& i) { i.odometry.clear(); }, "skipped detection: no pose yet");
  check([](Inputs& i) { i.sweeps.clear(); }, "skipped detection: no points");
}

TEST(CameraLidarStage, arrivalOrderHasNoInfluence) {
  Inputs inputs;
  inputs.odometry.clear();
  inputs.sweeps.clear();
  inputs.infos.clear();
  for (int i = 0; i < 70; ++i)
    inputs.odometry.push_back(test::odometry(kStart + i * 10 * kMillisecond, {0.2 * i, 0, 0}));
  for (int i = 0; i < 7; ++i) {
    inputs.sweeps.push_back(sweepOf(wall(40.0 + i, 9.0, 9.0, 0.2), kStart + i * 95 * kMillisecond));
    inputs.infos.push_back(simpleInfo("camera", kStart + i * 100 * kMillisecond));
    inputs.detections.push_back(detectionsOf({car(40, 30, 60, 50), car(50.0 + i, 35, 70, 55)},
                                             kStart + i * 100 * kMillisecond, static_cast<std::uint32_t>(i)));
  }
  const auto text = [&](unsigned seed) {
    CameraLidarStage stage(params());
    std::ostringstream out;
    out.precision(17);
    for (const Frustums& f : answers(stage, inputs, seed)) {
      out << f.stamp << " " << f.image_index;
      for (const Frustum& one : f.frustums) out << " " << one.distance_m << " " << one.position.transpose();
      out << "\n";
    }
    for (const auto& [key, count] : stage.counters().all()) out << key << " " << count << "\n";
    return out.str();
  };
  const std::string first = text(0);
  EXPECT_NE(first.find("frustums 14"), std::string::npos) << first;
  for (unsigned seed = 1; seed < 25; ++seed) EXPECT_EQ(text(seed), first) << seed;
}

// A plate of 1 m at 10 m in a box that is mostly wall: the paper's median is the wall.
TEST(CameraLidarStage, methodsOfDistance) {
  Inputs inputs;
  auto points = wall(20.0, 12.0, 9.0, 0.1);
  const auto plate = wall(10.0, 0.5, 0.5, 0.03);  // about as dense as the wall
  points.insert(points.end(), plate.begin(), plate.end());
  inputs.sweeps = {sweepOf(points, kStart - kMillisecond)};
  inputs.detections = {detectionsOf({car(40, 30, 60, 50)})};
  CameraLidarParams p = params();
  CameraLidarStage foreground(p);
  const Frustum found = answers(foreground, inputs)[0].frustums.at(0);
  EXPECT_NEAR(found.distance_m, 10.0, 1e-5);
  EXPECT_NEAR(found.corners[4].x() - found.corners[0].x(), 0.1, 1e-5) << "a plate has no depth";
  p.method = "median";
  CameraLidarStage median(p);
  const Frustum paper = answers(median, inputs)[0].frustums.at(0);
  EXPECT_NEAR(paper.distance_m, 20.0, 1e-5);
  EXPECT_NEAR(paper.corners[4].x() - paper.corners[0].x(), 1.0, 1e-5);
  p.method = "mean";
  EXPECT_THROW(validate(p), std::invalid_argument);
}

// The sweep that ends 80 ms after the image was measured around it; the image waits for it, not for later
// ones.
TEST(CameraLidarStage, waitsForTheSweepThatWasUnderWay) {
  Inputs inputs;
  inputs.sweeps = {sweepOf(wall(20.0, 12.0, 9.0, 0.1), kStart - 100 * kMillisecond),
                   sweepOf(wall(18.0, 12.0, 9.0, 0.1), kStart + 80 * kMillisecond),
                   sweepOf(wall(16.0, 12.0, 9.0, 0.1), kStart + 101 * kMillisecond)};
  inputs.detections = {detectionsOf({car(40, 30, 60, 50)})};
  CameraLidarParams p = params();
  p.look_ahead_s = 0.1;
  p.recent_s = 0.09;
  for (unsigned seed = 0; seed < 20; ++seed) {
    CameraLidarStage stage(p);
    EXPECT_NEAR(answers(stage, inputs, seed)[0].frustums.at(0).distance_m, 18.0, 1e-5) << seed;
  }
}

// Two cameras at one place see the same wall by the same box, 10 ms apart; the next images come 100 ms later.
TEST(CameraLidarStage, whatTwoCamerasSeeIsMerged) {
  CameraLidarParams p = params();
  p.cameras = {"a", "b"};
  const auto merged = [&](bool a_first) {
    CameraLidarStage stage(p);
    std::vector<Frustums> result;
    stage.on_merged = [&](const Frustums& f) { result.push_back(f); };
    stage.push(0, rig({{"a", forwardCamera()}, {"b", forwardCamera()}}));
    for (int i = -1; i < 60; ++i) stage.push(test::odometry(kStart + i * 10 * kMillisecond));
    stage.push(0, sweepOf(wall(20.0, 12.0, 9.0, 0.1), kStart - kMillisecond));
    for (const std::size_t c : a_first ? std::vector<std::size_t>{0, 1} : std::vector<std::size_t>{1, 0}) {
      for (int i = 0; i < 3; ++i) {
        const Stamp stamp = kStart + (100 * i + 10 * static_cast<int>(c)) * kMillisecond;
        stage.push(c, simpleInfo(c == 0 ? "a" : "b", stamp));
        stage.push(c, detectionsOf({car(60, 30, 80, 50)}, stamp, static_cast<std::uint32_t>(i)));
      }
    }
    for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
    EXPECT_EQ(stage.counters().get("frustums of the same object by another camera"), 3U);
    return result;
  };
  for (const bool a_first : {true, false}) {
    const auto result = merged(a_first);
    ASSERT_EQ(result.size(), 3U);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(result[i].stamp, kStart + 100 * i * kMillisecond);
      ASSERT_EQ(result[i].frustums.size(), 1U);
      EXPECT_NEAR(result[i].frustums[0].position.x(), 20.0, 1e-4);
    }
  }
}

TEST(CameraLidarStage, refusesBadParameters) {
  CameraLidarParams p = params();
  p.min_points = 0;
  EXPECT_THROW(CameraLidarStage{p}, std::invalid_argument);
  p = params();
  p.window_s = -1;
  EXPECT_THROW(CameraLidarStage{p}, std::invalid_argument);
  p = params();
  p.object_depth_m = 0;
  EXPECT_THROW(validate(p), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
