// SPDX-License-Identifier: MIT
#include "files/line_writer.hpp"

#include <cstdio>

namespace atlas {

LineWriter::LineWriter(const std::filesystem::path& out)
    : file_(std::make_unique<OutputFile>(out / "lines" / "lines.csv")) {
  file_->write(kLineHeader);
}

void LineWriter::write(const std::string& lidar, const Lines& lines) {
  const std::string sweep = std::to_string(lines.stamp) + "," + lidar + ",";
  std::size_t index = 0;
  for (const Line& l : lines.lines) {
    char row[400];
    const int length =
        std::snprintf(row, sizeof row, "%zu,%s,%u,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%u,%.4f,%.2f\n", index++,
                      toString(l.kind), static_cast<unsigned>(l.ring), l.from.x(), l.from.y(), l.from.z(),
                      l.to.x(), l.to.y(), l.to.z(), l.points, l.rms_m, l.intensity);
    file_->write(sweep);
    file_->write(row, static_cast<std::size_t>(length));
  }
}

void LineWriter::close() {
  if (file_) file_->commit();
  file_.reset();
}

}  // namespace atlas
