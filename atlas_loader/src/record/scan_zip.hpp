// SPDX-License-Identifier: MIT
// Scans in a zip archive, read by its directory and unpacked as a whole: half the time of a stream.
#pragma once

#include <filesystem>
#include <memory>

#include "record/scan_store.hpp"

namespace atlas::record {

/// nullptr when the archive has no directory that can be read (a copy that was cut, another kind of file).
std::unique_ptr<ScanStore> openScanZip(const std::filesystem::path& path);

}  // namespace atlas::record
