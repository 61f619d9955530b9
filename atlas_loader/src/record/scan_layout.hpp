// SPDX-License-Identifier: MIT
// In which order the points of a scan of the HDL-32E lie. A BUD scan says nothing about it, so the points do:
// a laser keeps its elevation. The time of a point depends on this, so it is never just assumed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas::record {

/// Velodyne HDL-32E: lasers fire together in columns of 32.
inline constexpr std::size_t kLasersHdl32 = 32;

struct ScanLayout {
  enum class Order {
    kColumns,  ///< firing by firing: point i is of column i / 32, place i % 32
    kRows,     ///< laser by laser: point i is of column i % C, place i / C, with C = size / 32
    kUnknown   ///< anything else, e.g. a scan whose empty returns were left out
  };
  Order order = Order::kUnknown;
  /// Laser, counted from the bottom, of each of the 32 places; a dead laser's is a guess.
  std::array<std::uint16_t, kLasersHdl32> ring{};
};

/// Scans with fewer than about 100 returns are taken as kColumns when their size is a multiple of 32.
ScanLayout findScanLayout(const std::vector<LidarPoint>& points);

}  // namespace atlas::record
