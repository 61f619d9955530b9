// SPDX-License-Identifier: MIT
// Reads the point clouds of PCD files (v0.6, v0.7: ascii, binary, binary_compressed) from memory, without
// PCL. Format: https://pointclouds.org/documentation/tutorials/pcd_file_format.html
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas::record {

struct PcdCloud {
  std::vector<LidarPoint> points;  ///< file order; time is 0 unless has_time, ring 0 unless has_ring
  std::vector<double> time_s;      ///< of each point as the file says, s; empty without such a field
  bool absolute_time = false;      ///< time_s is Unix time, else relative to the file's own zero
  bool has_ring = false;
  std::string error;  ///< why there is no cloud; "" = good
};

/// Fields used when present: x, y, z, intensity (or i, reflectivity), ring (or line), time (t, timestamp,
/// offset_time). Integers in a time field are ns.
PcdCloud parsePcd(std::string_view bytes);

/// LZF as in PCL and liblzf (M. Lehmann); false when the input does not give exactly `size` bytes.
bool decompressLzf(std::string_view input, std::size_t size, std::string& output);

}  // namespace atlas::record
