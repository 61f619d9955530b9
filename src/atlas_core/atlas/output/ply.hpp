// SPDX-License-Identifier: MIT
// The map as bytes of a PLY file, binary little endian (Turk 1994, "The PLY Polygon File Format").
#pragma once

#include <cstdint>
#include <string>

namespace atlas {

/// Header for `points` vertices x y z intensity (float), count (uint) and, if `coloured`, blue green red
/// alpha (uchar): mapRecords follow it.
[[nodiscard]] std::string mapPlyHeader(std::uint64_t points, bool coloured = false);

}  // namespace atlas
