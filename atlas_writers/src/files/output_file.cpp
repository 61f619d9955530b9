// SPDX-License-Identifier: MIT
#include "files/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "atlas/base/check.hpp"

namespace atlas {
namespace {

constexpr std::size_t kBuffer_bytes = 1U << 16U;

[[noreturn]] void fail(const std::string& what, const std::filesystem::path& path, int error) {
  throw std::runtime_error("cannot " + what + " " + path.string() + ": " +
                           std::generic_category().message(error));
}

}  // namespace

void ensureFolder(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail("create folder", folder, error.value());
  if (!std::filesystem::is_directory(folder)) fail("create folder", folder, ENOTDIR);
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  ensureFolder(path_.parent_path());
  temporary_ = path_.parent_path() / ("." + path_.filename().string() + ".part");
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail("create", temporary_, errno);
  buffer_.reserve(kBuffer_bytes);
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void OutputFile::write(const void* data, std::size_t bytes) {
  ATLAS_CHECK(descriptor_ >= 0, "write after commit: " + path_.string());
  bytes_ += bytes;
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const std::size_t part = std::min(bytes, kBuffer_bytes - buffer_.size());
    buffer_.append(at, part);
    at += part;
    bytes -= part;
    if (buffer_.size() == kBuffer_bytes) flush();
  }
}

void OutputFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", path_, errno);
    done += static_cast<std::size_t>(written);
  }
  buffer_.clear();
}

void OutputFile::commit() {
  ATLAS_CHECK(descriptor_ >= 0, "commit twice: " + path_.string());
  flush();
  const int result = ::close(std::exchange(descriptor_, -1));
  const int close_error = errno;
  if (result != 0) {
    ::unlink(temporary_.c_str());
    fail("close", path_, close_error);
  }
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int rename_error = errno;
    ::unlink(temporary_.c_str());
    fail("rename to", path_, rename_error);
  }
}

void writeFile(const std::filesystem::path& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.commit();
}

}  // namespace atlas
