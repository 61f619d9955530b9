// SPDX-License-Identifier: MIT
// Point clouds as bytes of a binary PCD file, version 0.7
// (https://pointclouds.org/documentation/tutorials/pcd_file_format.html): unorganized (height 1), little
// endian, fields packed without gaps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atlas/base/outcome.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// One voxel of the map.
struct MapPoint {
  float x = 0, y = 0, z = 0;  ///< m, map: mean of the returns
  float intensity = 0;        ///< mean, as recorded
  std::uint32_t count = 0;    ///< returns
  /// 0xFF000000 + red, green, blue, a byte each; 0: no camera has seen it.
  std::uint32_t colour = 0;
};
static_assert(sizeof(MapPoint) == 24, "MapPoint is written as it lies in memory");

/// A whole file: x y z intensity time (float32) and ring (uint16), in the order of the points, NaN kept.
[[nodiscard]] std::string encodePcd(const std::vector<LidarPoint>& points);
/// The points of a file that holds at least x y z as float32; other known fields are taken too, unknown ones
/// ignored. kBadLayout when it is no such binary PCD file, or a truncated one.
[[nodiscard]] Outcome<std::vector<LidarPoint>> decodePcd(const std::string& bytes);

/// Header for `points` MapPoints (x y z intensity as float32, count as uint32; `coloured`: rgb as PCL packs
/// it into a float32, too), whose mapRecords follow it.
[[nodiscard]] std::string mapPcdHeader(std::uint64_t points, bool coloured = false);
/// The bytes of the points, little endian; without their colours unless `coloured`.
[[nodiscard]] std::string mapRecords(const std::vector<MapPoint>& points, bool coloured = false);

}  // namespace atlas
