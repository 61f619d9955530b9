// SPDX-License-Identifier: MIT
// The tracker alone on detections in KITTI's format: detections in, result files of the tracking benchmark
// out.
#pragma once

#include <map>
#include <string>

#include "record/record_log.hpp"

namespace atlas_loader {

struct TrackKittiOptions {
  std::string detections, calibration, oxts;  ///< folders
  std::string out;                            ///< one <sequence>.txt each
};
struct TrackKittiReport {
  std::map<std::string, std::uint64_t> frames;  ///< by sequence
  double tracking_s = 0.0;                      ///< without reading and writing files
  atlas::record::RecordLog log;
};

/// Throws std::invalid_argument or std::runtime_error that names the folder, file or field.
TrackKittiReport trackKitti(const TrackKittiOptions& options);

}  // namespace atlas_loader
