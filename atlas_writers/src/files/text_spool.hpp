// SPDX-License-Identifier: MIT
// Text that grows outside memory until it finds its place in another file: the annotations of a COCO document
// come after the images, but both become known frame by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "atlas/base/spill_file.hpp"
#include "files/output_file.hpp"

namespace atlas {

class TextSpool {
 public:
  /// A temporary file without a name in `folder`. Functions throw std::runtime_error when the disk is full.
  explicit TextSpool(const std::filesystem::path& folder) : file_(folder) {}

  void append(std::string_view text);
  [[nodiscard]] bool empty() const { return stored_ == 0 && buffer_.empty(); }
  void copyTo(OutputFile& target) const;

 private:
  SpillFile file_;
  std::uint64_t stored_ = 0;  ///< bytes in the file
  std::string buffer_;        ///< those after them
};

}  // namespace atlas
