// SPDX-License-Identifier: MIT
// Text of a KITTI raw drive: timestamps.txt and one OXTS file per frame (oxts/dataformat.txt).
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "atlas/sensor/sensor.hpp"
#include "record/record_log.hpp"
#include "record/text_rows.hpp"

namespace atlas::record {

/// Stamps by frame number (line number - 1); a blank line is a frame that was not recorded. Rows go to the
/// log under `name`: the bad ones as skipped, the others are left to the caller.
std::map<std::uint32_t, Stamp> readKittiStamps(const std::filesystem::path& path, const std::string& name,
                                               RecordLog& log);

/// "2011-09-26 14:19:35.668269525" as if it were UTC; nullopt when it is none.
std::optional<Stamp> parseKittiStamp(std::string_view text);

/// One OXTS packet. Roll positive = left side up, pitch positive = front down, yaw 0 = east and
/// counter-clockwise: the fixed-axis angles of REP-103.
struct OxtsSample {
  ImuSample imu;        ///< specific force (ax, ay, az) and rates (wx, wy, wz) in the vehicle frame
  GnssFix fix;          ///< covariance from pos_accuracy when that is > 0
  GnssHeading heading;  ///< without variance: the file gives none
};
/// The file's one row of 30 numbers; faults are left in `fields`.
OxtsSample parseOxts(RowFields& fields, Stamp stamp);

}  // namespace atlas::record
