// SPDX-License-Identifier: MIT
// scans.zip or a folder of scan%06d.pcd, and the truth of points beside it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "synthetic/lidar.hpp"

struct archive;

namespace atlas::synthetic {

/// PCD v0.7, binary, fields x y z intensity (float), unorganised.
std::string toPcd(const std::vector<LidarReturn>& points);

/// A lidar's folder of the record.
class ScanWriter {
 public:
  ScanWriter(const std::filesystem::path& folder, bool zip);
  ~ScanWriter();
  ScanWriter(const ScanWriter&) = delete;
  ScanWriter& operator=(const ScanWriter&) = delete;
  /// Member scan<index, 6 digits>.pcd. Throws std::runtime_error when it cannot be written.
  void write(int index, const std::vector<LidarReturn>& points);
  /// Completes the archive.
  void close();

 private:
  std::filesystem::path folder_;
  archive* zip_ = nullptr;
};

/// float32 x y z (map, m) and object id per point; NaN = no return.
void writeTruthPoints(const std::filesystem::path& file, const std::vector<TruthPoint>& points);
/// Empty when the file is absent or its size is not a multiple of 16 bytes.
std::vector<TruthPoint> readTruthPoints(const std::filesystem::path& file);

}  // namespace atlas::synthetic
