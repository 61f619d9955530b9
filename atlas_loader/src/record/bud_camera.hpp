// SPDX-License-Identifier: MIT
// The cameras of a BUD record. Streams of one: <camera>/camera_info, camera_ir/temperature_range, the
// pictures
// (<camera>/packets, <camera>/image_raw/compressed or <camera>/image_raw), <camera>/detections.
#pragma once

#include <filesystem>
#include <string>

#include "record/calibration_file.hpp"
#include "record/merged_reader.hpp"

namespace atlas::record {

void addBudCamera(const std::filesystem::path& record, const std::string& camera, const RigFiles& rig,
                  const RecordOptions& options, StreamSet& streams, RecordParts& parts);

}  // namespace atlas::record
