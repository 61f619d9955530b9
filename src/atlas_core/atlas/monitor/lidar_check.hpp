// SPDX-License-Identifier: MIT
// The scans of a lidar: empty, frozen, fewer points than usual, dead beams, directions that are blocked.
#pragma once

#include <array>
#include <vector>

#include "atlas/monitor/findings.hpp"
#include "atlas/monitor/same_for.hpp"
#include "atlas/monitor/scan_summary.hpp"

namespace atlas {

class LidarCheck {
 public:
  /// `dead_rings`: beams that are known to be dead.
  explicit LidarCheck(std::vector<int> dead_rings) : dead_rings_(std::move(dead_rings)) {}
  void add(Stamp stamp, const ScanSummary& scan, Findings& findings);

 private:
  void measureCount(Stamp stamp, const ScanSummary& scan, Findings& findings);
  void measureBeams(Stamp stamp, const ScanSummary& scan, Findings& findings);
  void measureSectors(Stamp stamp, const ScanSummary& scan, Findings& findings);

  std::vector<int> dead_rings_;
  SameFor<std::uint64_t> same_;
  int scans_ = 0;
  double usual_returns_ = 0.0;
  std::array<std::uint32_t, kScanRings> ring_sum_{};
  Stamp rings_begin_ = kBeginOfTime;
  std::array<double, kScanSectors> usual_sector_{};
  std::array<int, kScanSectors> poor_scans_{};  ///< in a row
};

}  // namespace atlas
