// SPDX-License-Identifier: MIT
// What the camera tests share: the calibration of the Brno Urban Dataset, walls made of lidar points, a way
// to feed a stage in any order of arrival.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "atlas/camera/camera_model.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas::test {

constexpr Stamp kStart = 1'568'186'745'000'000'000;

inline CameraInfo cameraInfo(const std::string& frame, std::uint32_t width, std::uint32_t height, double fx,
                             double fy, double cx, double cy, std::vector<double> distortion,
                             Stamp stamp = kStart) {
  CameraInfo info;
  info.stamp = stamp;
  info.frame = frame;
  info.width = width;
  info.height = height;
  info.distortion_model = "plumb_bob";
  info.distortion = std::move(distortion);
  info.K = {fx, 0, cx, 0, fy, cy, 0, 0, 1};
  return info;
}
inline CameraInfo irInfo(Stamp stamp = kStart) {
  return cameraInfo("camera_ir", 640, 512, 526.4079, 526.1605, 328.7302, 266.0666,
                    {-0.292186, 0.109670, -0.00170026, -0.00301853, -0.0294095}, stamp);
}
inline CameraInfo leftFrontInfo(Stamp stamp = kStart) {
  return cameraInfo("camera_left_front", 1920, 1200, 1376.3974, 1377.1722, 959.2366, 576.7434,
                    {-0.172454, 0.112390, -0.000152537, 0.000384873, -0.0207703}, stamp);
}
inline std::vector<CameraInfo> budCameras() {
  return {leftFrontInfo(),
          cameraInfo("camera_left_side", 1920, 1200, 1032.9181, 1030.3822, 984.9253, 585.9841,
                     {-0.149692, 0.0741817, 0.000160745, 0.000144190, -0.0244091}),
          cameraInfo("camera_right_front", 1920, 1200, 1401.3103, 1396.0898, 1015.9141, 598.9315,
                     {-0.202329, 0.145248, -0.00131448, 0.00861272, -0.0579515}),
          cameraInfo("camera_right_side", 1920, 1200, 1006.7971, 1006.9716, 989.0966, 595.5736,
                     {-0.148052, 0.0741828, 0.000471891, 0.0000639203, -0.0154651}),
          irInfo()};
}
/// 101 x 81 pixels, 100 px focal length, no distortion: numbers that can be checked by hand.
inline CameraInfo simpleInfo(const std::string& frame = "camera", Stamp stamp = kStart) {
  return cameraInfo(frame, 101, 81, 100, 100, 50, 40, {0, 0, 0, 0, 0}, stamp);
}

/// Camera looking along x of the imu frame: optical x = -y, y = -z, z = x.
inline Pose forwardCamera(const Eigen::Vector3d& p_imu = Eigen::Vector3d::Zero()) {
  return {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), p_imu};
}
inline StaticTransforms rig(const std::vector<std::pair<std::string, Pose>>& sensors) {
  StaticTransforms transforms;
  for (const auto& [frame, T_imu_sensor] : sensors)
    transforms.transforms.push_back({"base_link", frame, T_imu_sensor});
  return transforms;
}

inline Odometry odometry(Stamp stamp, const Eigen::Vector3d& p_map = Eigen::Vector3d::Zero()) {
  Odometry result;
  result.stamp = stamp;
  result.T_map_imu.translation = p_map;
  return result;
}

inline LidarPoint point(double x, double y, double z) {
  LidarPoint p;
  p.x = static_cast<float>(x);
  p.y = static_cast<float>(y);
  p.z = static_cast<float>(z);
  return p;
}
/// Points of a sweep, all in one batch with the pose given.
inline BatchedSweepPtr sweepOf(std::vector<LidarPoint> points, Stamp stamp = kStart,
                               const Pose& T_map_lidar = {}) {
  auto sweep = std::make_shared<Sweep>();
  sweep->stamp = stamp;
  sweep->frame = "lidar";
  sweep->points = std::move(points);
  auto batched = std::make_shared<BatchedSweep>();
  batched->stamp = stamp;
  batched->frame = "lidar";
  batched->T_map_lidar = T_map_lidar;
  batched->batches = {{0, static_cast<std::uint32_t>(sweep->points.size()), stamp, T_map_lidar}};
  batched->sweep = sweep;
  return batched;
}
/// A wall x = distance, |y| <= half_width, |z| <= half_height, one point every `step`.
inline std::vector<LidarPoint> wall(double distance, double half_width, double half_height, double step,
                                    double center_y = 0.0) {
  std::vector<LidarPoint> points;
  const int columns = static_cast<int>(half_width / step), rows = static_cast<int>(half_height / step);
  for (int i = -columns; i <= columns; ++i) {
    for (int j = -rows; j <= rows; ++j) points.push_back(point(distance, center_y + i * step, j * step));
  }
  return points;
}

/// One input of a stage with its events in order.
struct Feed {
  std::size_t input = 0;
  std::vector<std::function<void()>> pushes;
};
/// Feeds all inputs, in the order that `seed` makes of them; order within an input is kept. 0: one input
/// after the other.
template <class AnyStage>
void run(AnyStage& stage, const std::vector<Feed>& feeds, unsigned seed) {
  std::vector<std::size_t> turns;
  for (std::size_t f = 0; f < feeds.size(); ++f) turns.insert(turns.end(), feeds[f].pushes.size() + 1, f);
  std::mt19937 random(seed);
  if (seed != 0) std::shuffle(turns.begin(), turns.end(), random);
  std::vector<std::size_t> next(feeds.size(), 0);
  for (const std::size_t f : turns) {
    if (next[f] < feeds[f].pushes.size()) {
      feeds[f].pushes[next[f]++]();
    } else {
      stage.finish(feeds[f].input);
    }
  }
}

}  // namespace atlas::test
