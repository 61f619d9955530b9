// SPDX-License-Identifier: MIT
#include "synthetic/text_file.hpp"

#include <cstdarg>
#include <stdexcept>
#include <vector>

namespace atlas::synthetic {

TextFile::TextFile(const std::filesystem::path& path, LineEnd line_end) : line_end_(line_end) {
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
  file_.reset(std::fopen(path.c_str(), "wb"));
  if (!file_) throw std::runtime_error("cannot write " + path.string());
}

void TextFile::print(const char* format, ...) {
  char text[1024];
  va_list arguments;
  va_start(arguments, format);
  const int length = std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (length < 0 || length >= static_cast<int>(sizeof text))
    throw std::logic_error("TextFile: line too long");
  for (int i = 0; i < length; ++i) {
    if (text[i] == '\n' && line_end_ == LineEnd::kDos) std::fputc('\r', file_.get());
    std::fputc(text[i], file_.get());
  }
}

}  // namespace atlas::synthetic
