// SPDX-License-Identifier: MIT
// Two cameras side by side whose images are rectified: a row of the left image is the same row of the right
// one, and a point at depth Z (m) lies disparity = focal_px * baseline_m / Z pixels further left in the
// right.
#pragma once

#include <optional>

#include "atlas/base/geometry.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct StereoRig {
  double focal_px = 0;
  double u0_px = 0,
         v0_px = 0;       ///< principal point of the left image; (0, 0) is the centre of its first pixel
  double baseline_m = 0;  ///< from the left to the right camera
  int width_px = 0, height_px = 0;
  /// Rotates the rectified left camera's optical axes into those of the left camera that took the image.
  Pose T_left_rectified;

  [[nodiscard]] double depthOf(double disparity_px) const { return focal_px * baseline_m / disparity_px; }
  [[nodiscard]] double disparityAt(double depth_m) const { return focal_px * baseline_m / depth_m; }
  /// Standard deviation of the depth (m) that a disparity error makes: it grows with the square of the depth.
  [[nodiscard]] double depthSigma(double depth_m, double disparity_sigma_px) const {
    return depth_m * depth_m * disparity_sigma_px / (focal_px * baseline_m);
  }
};

/// Throws std::invalid_argument that names the field and its value.
void validate(const StereoRig& rig);

}  // namespace atlas
