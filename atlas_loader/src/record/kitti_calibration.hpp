// SPDX-License-Identifier: MIT
// calib_imu_to_velo.txt, calib_velo_to_cam.txt and calib_cam_to_cam.txt of a KITTI raw drive.
//   x_velo = R_imu_to_velo x_imu + T,   x_cam0 = R_velo_to_cam x_velo + T,   x_rect0 = R_rect_00 x_cam0,
//   pixel ~ P_rect_0i x_rect0 = K (x_rect0 + K^-1 p4)   (Geiger et al. 2013, eq. 3..8; p4 = last column of
//   P_rect_0i)
// so camera i has its own rectified frame, moved by K^-1 p4 against that of camera 0.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas::record {

struct KittiCalibration {
  StaticTransforms transforms;  ///< parent base_link (the OXTS unit): imu, velodyne, image_02, image_03
  std::map<std::string, CameraInfo> cameras;  ///< "image_02", "image_03": rectified, no distortion
  std::vector<std::string> notes;             ///< what is missing
};

/// Files that are missing leave out what depends on them. Throws std::runtime_error naming file, line, field
/// and value.
KittiCalibration readKittiCalibration(const std::filesystem::path& folder);

}  // namespace atlas::record
