// SPDX-License-Identifier: MIT
// One way to open whatever the user names: a bag, a BUD record or a KITTI raw drive.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "atlas/sensor/record_reader.hpp"

namespace atlas_loader {

struct InputOptions {
  std::string bag;              ///< path of a bag; or
  std::string record;           ///< folder of a record
  std::string calibration;      ///< calibration folder for records that carry none; "" = the packaged rig
  std::string images = "h265";  ///< of records: "h265" packets as recorded, "jpeg", "raw"
  double start_s = 0.0;
  double duration_s = -1.0;
  std::vector<std::string> topics;  ///< empty = all
  /// Of records: s from the measurement to its stamp in the record, taken off again.
  double imu_latency_s = 0.0, gnss_latency_s = 0.0, lidar_latency_s = 0.0;
  std::string scan_stamp =
      "end";  ///< of records: "end" or "start" of a revolution is what a scan's stamp marks
};

/// Throws std::invalid_argument when not exactly one input is named, std::runtime_error naming the file
/// otherwise.
std::unique_ptr<atlas::RecordReader> openInput(const InputOptions& options);

/// "bud" or "kitti": the packaged configuration that fits the streams.
std::string configurationFor(const std::vector<atlas::StreamInfo>& streams);

/// <package>/<relative path> of an installed or built atlas package; throws std::runtime_error when it is not
/// found.
std::string packageFile(const std::string& package, const std::string& relative);

}  // namespace atlas_loader
