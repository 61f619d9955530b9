// SPDX-License-Identifier: MIT
// A camera that nobody has built: a place on the vehicle from which depth images are made, as a view from
// above. Without distortion; of a camera that looks straight down the depth is its height less that of what
// is seen.
#pragma once

#include <string>

#include "atlas/base/geometry.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct VirtualCameraParams {
  std::string name;         ///< topic prefix and frame; empty: there is none
  double x_m = 10.0;        ///< of its optical centre in base_link
  double y_m = 0.0;         ///< same
  double z_m = 40.0;        ///< same
  double pitch_deg = 90.0;  ///< 0 looks along x of base_link, 90 straight down with x upwards in the image
  double yaw_deg = 0.0;     ///< of that whole camera, to the left
  int width_px = 600;
  int height_px = 800;
  double focal_px = 400.0;  ///< straight down from z_m: focal_px / z_m pixels a metre on the ground
};
void validate(const VirtualCameraParams& params);

/// x right, y down, z forward of the image (REP-103) to base_link.
Pose T_imu_virtual(const VirtualCameraParams& params);
CameraInfo virtualInfo(const VirtualCameraParams& params, Stamp stamp);

}  // namespace atlas
