// SPDX-License-Identifier: MIT
// KITTI files (Geiger et al. 2013) as the camera tests need them: calibration, sweeps, poses, depth pictures.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "atlas/base/geometry.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas::test {

namespace fs = std::filesystem;

constexpr double kBaseline_m = 0.5327;

/// Folder below $ATLAS_DATA; empty when it is not there.
inline fs::path dataFolder(const std::string& name) {
  const char* data = std::getenv("ATLAS_DATA");
  const fs::path folder = data == nullptr ? fs::path() : fs::path(data) / name;
  return fs::is_directory(folder) ? folder : fs::path();
}

/// "key: numbers" of a calibration file.
inline std::map<std::string, std::vector<double>> calibration(const fs::path& path) {
  std::map<std::string, std::vector<double>> result;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    std::istringstream numbers(line.substr(colon + 1));
    for (double value = 0; numbers >> value;) result[line.substr(0, colon)].push_back(value);
  }
  return result;
}
inline Eigen::Matrix3d rotationOf(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}
inline Pose poseOf(const std::map<std::string, std::vector<double>>& file) {
  return {Eigen::Quaterniond(rotationOf(file.at("R"))).normalized(),
          Eigen::Vector3d(file.at("T")[0], file.at("T")[1], file.at("T")[2])};
}

/// image_02, rectified: its intrinsics and T_camera_velodyne.
struct KittiCamera {
  CameraInfo info;
  Pose T_camera_velodyne;
};
inline KittiCamera kittiCamera(const fs::path& cam_to_cam, const fs::path& velo_to_cam) {
  const auto cameras = calibration(cam_to_cam);
  const std::vector<double>& p = cameras.at("P_rect_02");
  KittiCamera result;
  result.info.width = static_cast<std::uint32_t>(cameras.at("S_rect_02")[0]);
  result.info.height = static_cast<std::uint32_t>(cameras.at("S_rect_02")[1]);
  result.info.K = {p[0], 0, p[2], 0, p[5], p[6], 0, 0, 1};
  const Pose rectify{Eigen::Quaterniond(rotationOf(cameras.at("R_rect_00"))).normalized(),
                     Eigen::Vector3d((p[3] - p[2] * p[11]) / p[0], (p[7] - p[6] * p[11]) / p[5], p[11])};
  result.T_camera_velodyne = rectify * poseOf(calibration(velo_to_cam));
  return result;
}

inline std::vector<LidarPoint> kittiSweep(const fs::path& path) {
  std::vector<LidarPoint> points;
  std::ifstream file(path, std::ios::binary);
  for (float row[4]; file.read(reinterpret_cast<char*>(row), sizeof row);) {
    LidarPoint point;
    point.x = row[0], point.y = row[1], point.z = row[2];
    points.push_back(point);
  }
  return points;
}

/// T_map_imu of an oxts file; map: Mercator at the latitude `lat0_deg`, the way of the KITTI development kit.
inline Pose oxtsPose(const fs::path& path, double lat0_deg) {
  constexpr double kEarth_m = 6378137.0, kDegree = M_PI / 180.0;
  std::ifstream file(path);
  double lat = 0, lon = 0, alt = 0;
  RollPitchYaw rpy;
  file >> lat >> lon >> alt >> rpy.roll >> rpy.pitch >> rpy.yaw;
  const double scale = std::cos(lat0_deg * kDegree);
  return {fromRollPitchYaw(rpy),
          {scale * kEarth_m * lon * kDegree,
           scale * kEarth_m * std::log(std::tan((90.0 + lat) * kDegree / 2)), alt}};
}

/// A 16-bit picture of z-depth x 256 as m, 0 = none.
inline cv::Mat kittiDepth(const fs::path& path) {
  cv::Mat depth;
  cv::imread(path.string(), cv::IMREAD_UNCHANGED).convertTo(depth, CV_32FC1, 1.0 / 256.0);
  return depth;
}

/// The same of a 16-bit picture of disparities x 256 px between the colour cameras.
inline cv::Mat depthOfDisparity(const fs::path& path, double focal_px) {
  cv::Mat depth = kittiDepth(path);
  for (int row = 0; row < depth.rows; ++row) {
    for (int column = 0; column < depth.cols; ++column) {
      float& value = depth.at<float>(row, column);
      if (value > 0.0F) value = static_cast<float>(focal_px * kBaseline_m) / value;
    }
  }
  return depth;
}

}  // namespace atlas::test
