// SPDX-License-Identifier: MIT
// What a scan looks like in a few numbers, from every seventh of its points: enough for the checks, and seven
// has no factor in common with the numbers of beams.
#pragma once

#include <array>
#include <cstdint>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

constexpr int kScanStride = 7;
constexpr std::size_t kScanSectors = 36, kScanRings = 256;

struct ScanSummary {
  std::uint32_t returns = 0;  ///< of the points looked at
  std::array<std::uint32_t, kScanRings> by_ring{};
  std::array<std::uint32_t, kScanSectors>
      by_sector{};                ///< those beyond kNearReturn_m, by azimuth, 10 deg each
  std::uint64_t fingerprint = 0;  ///< of their coordinates, bit by bit
};
constexpr float kNearReturn_m = 1.0F;

/// `visit(point)` sees every return that is looked at.
template <class Visit>
ScanSummary summaryOf(const Sweep& sweep, Visit&& visit);

/// Sector of a direction, 0 .. kScanSectors - 1.
std::size_t sectorOf(float x, float y);
/// Mixes the bits of a point into a fingerprint.
std::uint64_t mixedInto(std::uint64_t fingerprint, const LidarPoint& point);

template <class Visit>
ScanSummary summaryOf(const Sweep& sweep, Visit&& visit) {
  ScanSummary summary;
  for (std::size_t i = 0; i < sweep.points.size(); i += kScanStride) {
    const LidarPoint& p = sweep.points[i];
    if (!(p.x * p.x + p.y * p.y + p.z * p.z > 0.0F)) continue;  // NaN, too
    ++summary.returns;
    if (p.ring < kScanRings) ++summary.by_ring[p.ring];
    if (p.x * p.x + p.y * p.y > kNearReturn_m * kNearReturn_m) ++summary.by_sector[sectorOf(p.x, p.y)];
    summary.fingerprint = mixedInto(summary.fingerprint, p);
    visit(p);
  }
  return summary;
}

}  // namespace atlas
