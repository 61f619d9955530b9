// SPDX-License-Identifier: MIT
// Writes a complete record in the layout of the Brno Urban Dataset, with exact truth beside it in
// RECORD/truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "synthetic/options.hpp"

namespace atlas::synthetic {

/// How many rows, scans and frames were written, by stream; the same for the same options.
using DriveCounts = std::map<std::string, std::uint64_t>;

/// Writes the record; `progress` (may be empty) is told what is done and how far it is (0..1). Files that are
/// there are overwritten. Throws std::invalid_argument for bad options, std::runtime_error when a file cannot
/// be written.
DriveCounts writeDrive(const DriveOptions& options, const std::filesystem::path& record,
                       const std::function<void(const std::string&, double)>& progress = {});

}  // namespace atlas::synthetic
