// SPDX-License-Identifier: MIT
#include "atlas/output/ply.hpp"

namespace atlas {

std::string mapPlyHeader(std::uint64_t points, bool coloured) {
  const std::string colours =
      coloured ? "property uchar blue\nproperty uchar green\nproperty uchar red\nproperty uchar alpha\n" : "";
  return "ply\nformat binary_little_endian 1.0\ncomment frame map, east north up, m; count: returns per "
         "voxel" +
         std::string(coloured ? "; alpha 0: no colour known" : "") + "\n" + "element vertex " +
         std::to_string(points) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\nproperty uint "
         "count\n" +
         colours + "end_header\n";
}

}  // namespace atlas
