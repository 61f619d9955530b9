// SPDX-License-Identifier: MIT
// A temporary file without a name: the system frees it when the process ends, however it ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace atlas {

class SpillFile {
 public:
  /// Makes it in `folder`, and the folder where there is none. This and every other function throws
  /// std::runtime_error with folder and cause when the system refuses (a full disk, for example).
  explicit SpillFile(std::filesystem::path folder);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  void write(std::uint64_t offset, const void* data, std::size_t bytes);
  void read(std::uint64_t offset, void* data, std::size_t bytes) const;

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

}  // namespace atlas
