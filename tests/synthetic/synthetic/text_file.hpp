// SPDX-License-Identifier: MIT
// A text file written with printf formats in the C locale; "\n" in a format becomes the file's line end.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace atlas::synthetic {

class TextFile {
 public:
  enum class LineEnd { kUnix, kDos };
  /// Creates the folder; throws std::runtime_error when the file cannot be opened.
  TextFile(const std::filesystem::path& path, LineEnd line_end);
  __attribute__((format(printf, 2, 3))) void print(const char* format, ...);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  LineEnd line_end_;
};

}  // namespace atlas::synthetic
