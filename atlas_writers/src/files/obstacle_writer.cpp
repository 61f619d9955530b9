// SPDX-License-Identifier: MIT
#include "files/obstacle_writer.hpp"

#include <cstdio>

namespace atlas {

ObstacleWriter::ObstacleWriter(const std::filesystem::path& out)
    : file_(std::make_unique<OutputFile>(out / "obstacles" / "obstacles.csv")) {
  file_->write("stamp_ns,index,x,y,z,yaw,length,width,height,points\n");
}

void ObstacleWriter::write(const Obstacles& obstacles) {
  std::size_t index = 0;
  for (const Obstacle& o : obstacles.obstacles) {
    char row[400];
    const int length =
        std::snprintf(row, sizeof row, "%lld,%zu,%.4f,%.4f,%.4f,%.6f,%.4f,%.4f,%.4f,%u\n",
                      static_cast<long long>(obstacles.stamp), index++, o.center.x(), o.center.y(),
                      o.center.z(), o.yaw_rad, o.size.x(), o.size.y(), o.size.z(), o.points);
    file_->write(row, static_cast<std::size_t>(length));
  }
}

void ObstacleWriter::close() {
  if (file_) file_->commit();
  file_.reset();
}

}  // namespace atlas
