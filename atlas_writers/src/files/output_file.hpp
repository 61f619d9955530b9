// SPDX-License-Identifier: MIT
// A file that appears when it is complete: written under a temporary name in its own folder, renamed by
// commit(). Whoever sees a file of a run sees all of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace atlas {

/// Creates the folder and its parents. Throws std::runtime_error with path and cause.
void ensureFolder(const std::filesystem::path& folder);

class OutputFile {
 public:
  /// Opens `<folder>/.<name>.part`, creating the folder; the file itself is not touched before commit().
  /// This and every other function throws std::runtime_error with path and cause when the system refuses.
  explicit OutputFile(std::filesystem::path path);
  /// Without commit() nothing remains.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Closes and renames, replacing an older file. Nothing can be written afterwards.
  void commit();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Bytes written so far.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  void flush();

  std::filesystem::path path_, temporary_;
  int descriptor_ = -1;
  std::string buffer_;
  std::size_t bytes_ = 0;
};

/// A whole file at once.
void writeFile(const std::filesystem::path& path, std::string_view content);

}  // namespace atlas
