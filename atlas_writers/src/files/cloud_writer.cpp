// SPDX-License-Identifier: MIT
#include "files/cloud_writer.hpp"

#include <cstdio>

#include "atlas/lidar/batched_points.hpp"
#include "atlas/output/pcd.hpp"
#include "files/output_file.hpp"

namespace atlas {

bool CloudWriter::write(const std::string& lidar, std::uint32_t index, const BatchedSweep& batched) {
  if (batched.batches.empty()) return false;
  char name[24];
  std::snprintf(name, sizeof name, "%06u.pcd", index);
  writeFile(out_ / "deskewed" / lidar / name, encodePcd(inMap(batched).points));
  return true;
}

}  // namespace atlas
