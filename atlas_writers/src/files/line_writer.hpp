// SPDX-License-Identifier: MIT
// lines/lines.csv: one row per line that a laser drew, ends in m in map (see kLineHeader).
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "atlas/sensor/lines.hpp"
#include "files/output_file.hpp"

namespace atlas {

constexpr const char* kLineHeader =
    "stamp_ns,lidar,index,kind,ring,x_from,y_from,z_from,x_to,y_to,z_to,points,rms,intensity\n";

class LineWriter {
 public:
  explicit LineWriter(const std::filesystem::path& out);
  void write(const std::string& lidar, const Lines& lines);
  /// Completes the file; nothing happens a second time.
  void close();

 private:
  std::unique_ptr<OutputFile> file_;
};

}  // namespace atlas
