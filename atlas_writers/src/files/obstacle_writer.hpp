// SPDX-License-Identifier: MIT
// obstacles/obstacles.csv: stamp_ns,index,x,y,z,yaw,length,width,height,points (map), one row per box and
// sweep.
#pragma once

#include <filesystem>
#include <memory>

#include "atlas/sensor/products.hpp"
#include "files/output_file.hpp"

namespace atlas {

class ObstacleWriter {
 public:
  explicit ObstacleWriter(const std::filesystem::path& out);
  void write(const Obstacles& obstacles);
  /// Completes the file; nothing happens a second time.
  void close();

 private:
  std::unique_ptr<OutputFile> file_;
};

}  // namespace atlas
