// SPDX-License-Identifier: MIT
// Where the parts of a KITTI raw drive lie, and its per-frame files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas::record {

struct KittiFiles {
  std::map<std::string, std::filesystem::path>
      sensors;                        ///< "oxts", "velodyne_points", "image_02", "image_03"
  std::filesystem::path calibration;  ///< folder of calib_*.txt; empty = none
  std::vector<std::string> notes;
  /// Folder of a sensor, empty when there is none.
  [[nodiscard]] std::filesystem::path sensor(const std::string& name) const;
};

/// Looks in the folder and up to four levels below for <sensor>/data and calib_cam_to_cam.txt; calibration
/// also in the two folders above, their calib/, and `calibration_dir`. Throws std::invalid_argument when a
/// sensor is there twice (several drives).
KittiFiles findKittiFiles(const std::filesystem::path& folder, const std::string& calibration_dir);

/// "0000000012.png" -> 12, for the given extensions; the paths of a number are sorted (png and jpg of one
/// frame).
std::map<std::uint32_t, std::vector<std::filesystem::path>> kittiFrameFiles(
    const std::filesystem::path& folder, const std::vector<std::string>& extensions);
/// Number with ten digits and the extension.
std::string kittiFileName(std::uint32_t index, const std::string& extension);
std::optional<std::string> readWholeFile(const std::filesystem::path& path);

/// A whole PNG or JPEG as it is, or decoded to bgr8; nullptr when damaged. Without stamp.
std::shared_ptr<Image> kittiImage(const std::string& bytes, bool decode);

}  // namespace atlas::record
