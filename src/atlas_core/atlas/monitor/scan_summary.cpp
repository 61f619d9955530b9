// SPDX-License-Identifier: MIT
#include "atlas/monitor/scan_summary.hpp"

#include <cmath>
#include <cstring>

namespace atlas {

std::size_t sectorOf(float x, float y) {
  constexpr auto kHalfTurn = static_cast<float>(M_PI);
  const float turn = (std::atan2(y, x) + kHalfTurn) / (2.0F * kHalfTurn);  // 0..1
  return static_cast<std::size_t>(turn * static_cast<float>(kScanSectors)) % kScanSectors;
}

/// FNV-1a (Fowler, Noll, Vo) over the three coordinates.
std::uint64_t mixedInto(std::uint64_t fingerprint, const LidarPoint& point) {
  constexpr std::uint64_t kPrime = 1099511628211ULL;
  for (const float value : {point.x, point.y, point.z}) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    fingerprint = (fingerprint ^ bits) * kPrime;
  }
  return fingerprint;
}

}  // namespace atlas
