// SPDX-License-Identifier: MIT
// The calibration of a stereo pair from a file or folder:
// - KITTI: calib_cam_to_cam.txt (P_rect_02, P_rect_03, S_rect_02) or the form of the benchmarks (P2, P3);
// - YAML of a rectified pair: f, u0, v0 (px), baseline (m), and if known height (m) and pitch (deg, down) of
// the
//   camera above the road;
// - a folder with camera_<name>.yaml and frames.yaml (atlas_bringup/config/rigs): the images are rectified
// first.
#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct PairCalibration {
  CameraInfo left, right;
  std::optional<Pose> T_left_right;
  double height_m = 0;   ///< of the left camera above the road, 0 = unknown
  double pitch_deg = 0;  ///< down
};

struct PairNames {
  std::string left, right;  ///< of the cameras; empty: image_02 and image_03, or the two front cameras
};

/// `size`: of the images, for files that do not tell it. Throws std::runtime_error naming file, line, field
/// and value.
PairCalibration readPairCalibration(const std::filesystem::path& path, const PairNames& names, cv::Size size);

}  // namespace atlas
