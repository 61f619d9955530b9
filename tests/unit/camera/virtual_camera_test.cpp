// SPDX-License-Identifier: MIT
#include "atlas/camera/virtual_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "atlas/camera/depth_stage.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

/// 20 m above a place 5 m ahead, 10 pixels a metre on the ground z = 0.
VirtualCameraParams birdView() {
  VirtualCameraParams params;
  params.name = "bird_view";
  params.x_m = 5.0;
  params.z_m = 20.0;
  params.width_px = 101;
  params.height_px = 201;
  params.focal_px = 200.0;
  return params;
}

Eigen::Vector2d pixelOf(const VirtualCameraParams& params, const Eigen::Vector3d& p_imu) {
  const CameraModel model = CameraModel::fromInfo(virtualInfo(params, kStart)).value();
  return model.project(T_imu_virtual(params).inverse() * p_imu).value();
}

TEST(VirtualCamera, straightDownAheadIsUp) {
  const VirtualCameraParams params = birdView();
  EXPECT_NEAR((pixelOf(params, {5, 0, 0}) - Eigen::Vector2d(50, 100)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((pixelOf(params, {9, 0, 0}) - Eigen::Vector2d(50, 60)).norm(), 0.0, 1e-9) << "4 m ahead";
  EXPECT_NEAR((pixelOf(params, {5, 3, 0}) - Eigen::Vector2d(20, 100)).norm(), 0.0, 1e-9) << "3 m to the left";
  EXPECT_NEAR((pixelOf(params, {9, 0, 10}) - Eigen::Vector2d(50, 20)).norm(), 0.0, 1e-9) << "half as far";
}

TEST(VirtualCamera, pitchAndYaw) {
  VirtualCameraParams params = birdView();
  params.pitch_deg = 0.0;
  params.yaw_deg = 90.0;  // looks to the left
  EXPECT_NEAR((pixelOf(params, {5, 10, 20}) - Eigen::Vector2d(50, 100)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((pixelOf(params, {6, 10, 19}) - Eigen::Vector2d(70, 120)).norm(), 0.0, 1e-9);
  params.pitch_deg = 45.0;
  EXPECT_NEAR((pixelOf(params, {5, 10, 10}) - Eigen::Vector2d(50, 100)).norm(), 0.0, 1e-9);
}

/// A place with one point every `step`, level at height z.
void level(std::vector<LidarPoint>& points, double x, double y, double half, double z, double step) {
  const int count = static_cast<int>(std::lround(half / step));
  for (int i = -count; i <= count; ++i) {
    for (int j = -count; j <= count; ++j) points.push_back(point(x + i * step, y + j * step, z));
  }
}

// A box of 2 m x 2 m, 1.5 m high, 2 m ahead of the middle and 2 m to the left; the vehicle stands at (100,
// 50).
TEST(VirtualCamera, heightsOfAKnownScene) {
  DepthParams params;
  params.cameras = {"camera"};
  params.lidars = {"lidar"};
  params.look_ahead_s = 0.0;
  params.virtual_camera = birdView();
  EXPECT_EQ(params.names(), (std::vector<std::string>{"camera", "bird_view"}));
  DepthStage stage(params);
  std::vector<std::pair<std::size_t, DepthImagePtr>> images;
  stage.on_depth = [&](std::size_t camera, const DepthImagePtr& image) {
    images.emplace_back(camera, image);
  };
  std::vector<LidarPoint> points;
  level(points, 5.0, 0.0, 8.0, 0.0, 0.05);
  level(points, 7.0, 2.0, 1.0, 1.5, 0.05);
  const Pose T_map_imu{Eigen::Quaterniond::Identity(), {100.0, 50.0, 0.0}};
  stage.push(0, rig({{"camera", forwardCamera()}}));
  for (int i = -1; i <= 1; ++i) stage.push(odometry(kStart + i * kMillisecond, T_map_imu.translation));
  stage.push(0, sweepOf(points, kStart, T_map_imu));
  stage.push(0, simpleInfo("camera", kStart));
  for (std::size_t input = 0; input < stage.inputs(); ++input) stage.finish(input);
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].first, 0U);
  EXPECT_EQ(images[1].first, 1U);
  const DepthImage& view = *images[1].second;
  EXPECT_EQ(view.camera, "bird_view");
  EXPECT_EQ(view.stamp, kStart);
  EXPECT_EQ(view.image_index, images[0].second->image_index);
  EXPECT_EQ(view.camera_info.frame, "bird_view");
  const auto at = [&](double x, double y, double z) {
    const Eigen::Vector2d px = pixelOf(params.virtual_camera, {x, y, z});
    return view.depth.at<float>(static_cast<int>(std::lround(px.y())), static_cast<int>(std::lround(px.x())));
  };
  EXPECT_NEAR(at(5.0, 0.0, 0.0), 20.0, 1e-4) << "the ground";
  EXPECT_NEAR(at(7.0, 2.0, 1.5), 18.5, 1e-4) << "on top of the box";
  EXPECT_NEAR(at(6.1, 1.1, 1.5), 18.5, 1e-4) << "inside its edge";
  EXPECT_NEAR(at(5.7, 0.7, 0.0), 20.0, 1e-4) << "beside it";
}

TEST(VirtualCamera, refusesBadParameters) {
  VirtualCameraParams bad = birdView();
  bad.focal_px = 0.0;
  EXPECT_THROW(validate(bad), std::invalid_argument);
  bad = birdView();
  bad.height_px = 100000;
  EXPECT_THROW(validate(bad), std::invalid_argument);
  bad = birdView();
  bad.yaw_deg = std::nan("");
  EXPECT_THROW(validate(bad), std::invalid_argument);
  DepthParams twice;
  twice.virtual_camera.name = twice.cameras.at(0);
  EXPECT_THROW(validate(twice), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
