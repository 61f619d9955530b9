// SPDX-License-Identifier: MIT
// What a BUD record should hold, and notes about what it lacks or has besides: nothing is left out without a
// word.
#pragma once

#include <filesystem>

#include "atlas/sensor/sensor.hpp"
#include "record/record_log.hpp"

namespace atlas::record {

inline constexpr const char* kBudLidars[] = {"lidar_left", "lidar_right", "lidar_center"};
inline constexpr const char* kBudCameras[] = {"camera_left_front", "camera_left_side", "camera_right_front",
                                              "camera_right_side", "camera_ir"};

/// Files that every record of the dataset has (lidar_center, radar_ti and yolo are optional).
void noteMissingFiles(const std::filesystem::path& record, RecordLog& log);
/// Files and folders that no reader looks at.
void noteUnreadFiles(const std::filesystem::path& record, RecordLog& log);
/// Sensors of the record that have no place on the vehicle.
void noteMissingFrames(const std::filesystem::path& record, const StaticTransforms& rig, RecordLog& log);

}  // namespace atlas::record
