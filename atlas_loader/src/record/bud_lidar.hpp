// SPDX-License-Identifier: MIT
// The lidars of a BUD record: timestamps.txt and the scans give sweeps and the readings of the lidar's own
// clock.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "record/merged_reader.hpp"

namespace atlas::record {

/// Adds the sources of one lidar when its folder has a timestamps.txt. Streams: <lidar>/points, <lidar>/time.
void addBudLidar(const std::filesystem::path& record, const std::string& lidar, const RecordOptions& options,
                 StreamSet& streams, RecordParts& parts);

}  // namespace atlas::record
