// SPDX-License-Identifier: MIT
// Opens a recorded drive from a folder: a Brno Urban Dataset (BUD) record or a KITTI raw drive.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "atlas/sensor/record_reader.hpp"

namespace atlas {

struct RecordOptions {
  /// How camera pictures are delivered: packets as recorded, JPEG or PNG bytes, or decoded pixels.
  enum class Images { kPackets, kEncoded, kPixels };
  /// Which end of its revolution the stamp of a rotating lidar's scan marks. BUD does not document it; Atlas
  /// Fusion assumes the end.
  enum class ScanStamp { kStart, kEnd };

  std::string calibration_dir;      ///< used when the record brings none of its own; "" = packaged_rig_dir
  std::string packaged_rig_dir;     ///< last resort (BUD): frames.yaml and camera_*.yaml
  double start_s = 0;               ///< s after the first stamp of the record
  double duration_s = -1;           ///< s; negative = to the end
  std::vector<std::string> topics;  ///< only these (and tf_static); empty = all
  Images images = Images::kPackets;
  ScanStamp scan_stamp = ScanStamp::kEnd;
  double imu_latency_s = 0;    ///< subtracted from the stamps of imu/*
  double gnss_latency_s = 0;   ///< subtracted from the stamps of gnss/*
  double lidar_latency_s = 0;  ///< subtracted from the stamps of all lidars
};

/// Throws std::invalid_argument that names the field and its value.
void validate(const RecordOptions& options);

/// Detects the format. Throws std::invalid_argument when the folder is no record or the options are bad, and
/// std::runtime_error naming file, line, field and value when a calibration file is unusable. Bad data never
/// throws: it is counted in report().
std::unique_ptr<RecordReader> openRecord(const std::filesystem::path& folder, const RecordOptions& options);

}  // namespace atlas
