// SPDX-License-Identifier: MIT
// A record of the Brno Urban Dataset (Ligocki et al. 2020). Streams, in this order: tf_static; imu/data,
// imu/mag, imu/pressure, imu/temperature, imu/time, imu/gnss/fix; gnss/fix, gnss/heading, gnss/time;
// lidar_left|right|center/points and /time; radar_ti/scan; then for camera_left_front, left_side,
// right_front, right_side, ir: camera_info, temperature_range (ir), pictures, detections. A sensor that the
// record does not have has no streams.
#pragma once

#include <filesystem>
#include <memory>

#include "record/open_record.hpp"

namespace atlas::record {

bool isBudRecord(const std::filesystem::path& folder);
std::unique_ptr<RecordReader> openBudRecord(const std::filesystem::path& folder,
                                            const RecordOptions& options);

}  // namespace atlas::record
