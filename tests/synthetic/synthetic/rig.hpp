// SPDX-License-Identifier: MIT
// The calibration of the real Brno Urban Dataset rig
// (github.com/Robotics-BUT/Brno-Urban-Dataset-Calibrations): where the sensors sit (T_imu_sensor) and how the
// cameras see. The camera model is written out here on its own, so that the truth does not depend on the code
// that is tested with it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "atlas/base/geometry.hpp"

namespace atlas::synthetic {

struct RigFrame {
  std::string name;
  Eigen::Vector3d translation;
  Eigen::Vector4d rotation;  ///< x y z w as written in frames.yaml, not normalized
  [[nodiscard]] Pose T_imu_sensor() const {
    return {Eigen::Quaterniond(rotation[3], rotation[0], rotation[1], rotation[2]).normalized(), translation};
  }
};

/// OpenCV plumb_bob. Pixel centres have whole coordinates.
struct Camera {
  std::string name;  ///< camera_left_front, ...
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
  [[nodiscard]] bool thermal() const { return name == "camera_ir"; }
  /// Pixel of (x/z, y/z). The caller keeps away from points behind the camera.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& tangent) const;
  /// (x/z, y/z) of a pixel by Newton's method, to 1e-12.
  [[nodiscard]] Eigen::Vector2d undistort(const Eigen::Vector2d& pixel) const;
};

const std::vector<RigFrame>& rigFrames();
/// Throws std::invalid_argument for a frame that the rig does not have.
Pose T_imu_sensor(const std::string& frame);
/// The four RGB cameras at `rgb_scale` of 1920x1200, then camera_ir at 640x512.
std::vector<Camera> rigCameras(double rgb_scale);
/// RECORD/calibrations: frames.yaml and camera_*.yaml in the dataset's own layout.
void writeCalibrations(const std::filesystem::path& folder, double rgb_scale);

}  // namespace atlas::synthetic
