// SPDX-License-Identifier: MIT
// Calibration files of the Brno Urban Dataset: frames.yaml (pose of each sensor in the imu frame: p_imu = R
// p_sensor + t) and camera_<name>.yaml (intrinsics). Old files too: arrays without commas, `ir_camera`
// instead of `camera_ir`.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas::record {

struct RigFiles {
  StaticTransforms transforms;                ///< parent base_link, sorted by child, with imu as identity
  std::map<std::string, CameraInfo> cameras;  ///< without stamp; width and height 0 when the file has none
  std::vector<std::string> notes;
};

/// Reads what is there; no file is mandatory. Throws std::runtime_error naming file, line, field and value.
RigFiles readRigFiles(const std::filesystem::path& folder);
/// The folder itself when it has a *.yaml file, else the first one of such below it (the dataset's clone.sh
/// clones the calibration repository into calibrations/); empty when there is none.
std::filesystem::path calibrationIn(const std::filesystem::path& folder);

}  // namespace atlas::record
