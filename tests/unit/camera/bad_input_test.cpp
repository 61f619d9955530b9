// SPDX-License-Identifier: MIT
// Input that a real camera driver or detector can deliver, through the whole stages: a changed resolution, no
// or zero intrinsics, boxes outside the image, classes that nobody knows.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "atlas/camera/camera_lidar_stage.hpp"
#include "atlas/camera/depth_stage.hpp"
#include "atlas/camera/thermal_stage.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

constexpr Stamp ms(int milliseconds) { return kStart + milliseconds * kMillisecond; }

/// Half the resolution of simpleInfo: the same view in half as many pixels.
CameraInfo halfInfo(Stamp stamp) {
  return cameraInfo("camera", 51, 41, 50, 50, 25, 20, {0, 0, 0, 0, 0}, stamp);
}

template <class AnyStage>
void pushScene(AnyStage& stage) {
  stage.push(0, rig({{"camera", forwardCamera()}}));
  for (int i = -1; i <= 60; ++i) stage.push(odometry(ms(10 * i)));
  for (int i = 0; i < 5; ++i) stage.push(0, sweepOf(wall(10.0, 8.0, 8.0, 0.05), ms(100 * i)));
}
template <class AnyStage>
void finishAll(AnyStage& stage) {
  for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  EXPECT_TRUE(stage.ended());
}

TEST(BadCameraInput, depthImagesFollowAChangedResolution) {
  DepthParams params;
  params.cameras = {"camera"};
  params.lidars = {"lidar"};
  DepthStage stage(params);
  std::vector<DepthImagePtr> images;
  stage.on_depth = [&](std::size_t, const DepthImagePtr& image) { images.push_back(image); };
  pushScene(stage);
  CameraInfo zero = simpleInfo("camera", ms(220));
  zero.width = zero.height = 0;
  CameraInfo broken = simpleInfo("camera", ms(240));
  broken.distortion = {std::nan(""), 0, 0, 0, 0};
  for (const CameraInfo& info :
       {simpleInfo("camera", ms(200)), zero, broken, halfInfo(ms(260)), simpleInfo("camera", ms(280))})
    stage.push(0, info);
  finishAll(stage);
  ASSERT_EQ(images.size(), 5U) << "every frame is answered";
  EXPECT_EQ(images[0]->depth.size(), cv::Size(101, 81));
  EXPECT_TRUE(images[1]->depth.empty());
  EXPECT_TRUE(images[2]->depth.empty());
  EXPECT_EQ(images[3]->depth.size(), cv::Size(51, 41));
  EXPECT_EQ(images[4]->depth.size(), cv::Size(101, 81));
  for (const std::size_t i : {0U, 3U, 4U}) {
    EXPECT_EQ(images[i]->image_index, i);
    EXPECT_FLOAT_EQ(images[i]->depth.at<float>(20, 25), 10.0F) << i;
  }
  EXPECT_EQ(stage.counters().get("skipped depth image: camera_info missing or zero"), 1U);
  EXPECT_EQ(stage.counters().get("skipped depth image: not finite"), 1U);
}

TEST(BadCameraInput, detectionsOutsideTheImageAndOfUnknownClasses) {
  CameraLidarParams params;
  params.cameras = {"camera"};
  params.lidars = {"lidar"};
  CameraLidarStage stage(params);
  std::vector<Frustums> answers;
  stage.on_frustums = [&](std::size_t, const Frustums& f) { answers.push_back(f); };
  pushScene(stage);
  const double inf = std::numeric_limits<double>::infinity();
  Detections detections;
  detections.frame = "camera";
  detections.boxes = {{40, 30, 60, 50, 4711, 0.5},  {40, 30, 60, 50, -1, 0.5},
                      {-500, -500, -1, -1, 2, 0.9}, {60, 30, 40, 50, 2, 0.9},
                      {-inf, 0, inf, 20, 2, 0.9},   {-1e12, -1e12, 1e12, 1e12, 2, 0.9},
                      {70, 30, 80, 40, 2, 0.9}};
  for (const Stamp stamp : {ms(200), ms(260)}) {
    stage.push(0, stamp == ms(200) ? simpleInfo("camera", stamp) : halfInfo(stamp));
    detections.stamp = stamp;
    stage.push(0, detections);
  }
  finishAll(stage);
  ASSERT_EQ(answers.size(), 2U);
  ASSERT_EQ(answers[0].frustums.size(), 4U);
  EXPECT_EQ(answers[0].frustums[0].detection.class_id, 4711) << "a class is handed on as it came";
  EXPECT_EQ(answers[0].frustums[1].detection.class_id, -1);
  for (const Frustum& f : answers[0].frustums) EXPECT_NEAR(f.distance_m, 10.0, 1e-4);
  EXPECT_EQ(answers[1].frustums.size(), 3U) << "the last box is outside the smaller image";
  EXPECT_EQ(stage.counters().get("skipped detection: empty"), 5U);
  EXPECT_EQ(stage.counters().get("skipped detection: not finite"), 2U);
  EXPECT_EQ(stage.counters().get("detections"), 14U);
}

TEST(BadCameraInput, thermalFramesOfOtherSizesAndWithoutIntrinsics) {
  ThermalParams params;
  params.thermal_camera = "camera";
  params.cameras = {"rgb"};
  params.lidars = {};
  ThermalStage stage(params);
  std::vector<ProjectedDetections> answers;
  stage.on_projected = [&](const ProjectedDetections& p) { answers.push_back(p); };
  stage.push(0, rig({{"camera", forwardCamera()}}));
  for (int i = -1; i <= 60; ++i) stage.push(odometry(ms(10 * i)));
  CameraInfo zero = simpleInfo("camera", ms(133));
  zero.K = {};
  for (const CameraInfo& info : {simpleInfo("camera", ms(33)), zero, halfInfo(ms(233))})
    stage.pushThermal(info);
  for (int i = 0; i < 3; ++i) {
    Frustums frustums;
    frustums.stamp = ms(33 + 100 * i);
    Frustum plate;  // 2 m x 2 m at 10 m
    const std::array<Eigen::Vector2d, 4> around = {Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1),
                                                   Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1)};
    for (std::size_t k = 0; k < 8; ++k)
      plate.corners[k] = {k < 4 ? 10.0 : 10.5, around[k % 4].x(), around[k % 4].y()};
    Frustum lost = plate;
    for (Eigen::Vector3d& corner : lost.corners) corner.x() = std::nan("");
    frustums.frustums = {plate, lost};
    stage.push(0, frustums);
  }
  finishAll(stage);
  ASSERT_EQ(answers.size(), 3U);
  ASSERT_EQ(answers[0].detections.boxes.size(), 1U);
  EXPECT_NEAR(answers[0].detections.boxes[0].x_max - answers[0].detections.boxes[0].x_min, 20.0, 1e-9);
  EXPECT_TRUE(answers[1].detections.boxes.empty());
  ASSERT_EQ(answers[2].detections.boxes.size(), 1U);
  EXPECT_NEAR(answers[2].detections.boxes[0].x_max - answers[2].detections.boxes[0].x_min, 10.0, 1e-9);
  EXPECT_EQ(stage.counters().get("skipped thermal box: camera_info missing or zero"), 2U);
}

}  // namespace
}  // namespace atlas::test
