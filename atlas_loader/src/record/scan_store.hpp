// SPDX-License-Identifier: MIT
// The scans of a BUD lidar, wherever they lie: scan%06d.pcd in the sensor's folder, in scans/ or inside
// scans.zip (read in place, never unpacked).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace atlas::record {

constexpr std::size_t kMaxScan = 256u << 20;  ///< bytes unpacked: stops a damaged or hostile file

struct ScanBytes {
  std::string bytes;
  std::string error;  ///< why there are none; "" = good
};

class ScanStore {
 public:
  virtual ~ScanStore() = default;
  /// Scan numbers present, ascending.
  [[nodiscard]] virtual const std::vector<std::uint32_t>& indices() const = 0;
  /// Cheapest in the order in which the scans lie in the file.
  virtual ScanBytes read(std::uint32_t index) = 0;
  /// Trouble met while listing; "" = none.
  [[nodiscard]] virtual std::string listingError() const { return ""; }
  /// Files or members whose number was there already; the first one counts.
  [[nodiscard]] virtual std::uint64_t repeated() const { return 0; }
  /// Relative to the sensor's folder: "scans.zip", "scans" or "".
  [[nodiscard]] virtual std::string place() const = 0;
};

/// The first of: folder with scans, scans/, scans.zip. nullptr without any of them.
std::unique_ptr<ScanStore> openScanStore(const std::filesystem::path& sensor_folder);

/// 12 of "scan000012.pcd" or "some/folder/scan12.pcd".
std::optional<std::uint32_t> scanIndex(const std::string& file_name);

}  // namespace atlas::record
