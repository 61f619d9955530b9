// SPDX-License-Identifier: MIT
// objects/objects.csv, and objects/kitti.txt in the format of the KITTI tracking benchmark: its camera sits
// in base_link and looks forward (x right, y down, z forward), there is no image, the frame counts the
// updates.
#pragma once

#include <filesystem>
#include <memory>

#include "atlas/sensor/object.hpp"
#include "files/output_file.hpp"

namespace atlas {

class ObjectWriter {
 public:
  explicit ObjectWriter(const std::filesystem::path& out);
  void write(const Objects& objects);
  /// Completes the files; nothing happens a second time.
  void close();

 private:
  std::unique_ptr<OutputFile> csv_, kitti_;
  std::uint32_t frame_ = 0;
};

}  // namespace atlas
