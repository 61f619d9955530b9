// SPDX-License-Identifier: MIT
#include "files/text_spool.hpp"

#include <algorithm>

namespace atlas {
namespace {

constexpr std::size_t kBuffer_bytes = 1U << 16U;

}  // namespace

void TextSpool::append(std::string_view text) {
  buffer_.append(text);
  if (buffer_.size() < kBuffer_bytes) return;
  file_.write(stored_, buffer_.data(), buffer_.size());
  stored_ += buffer_.size();
  buffer_.clear();
}

void TextSpool::copyTo(OutputFile& target) const {
  std::string part;
  for (std::uint64_t at = 0; at < stored_; at += part.size()) {
    part.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBuffer_bytes, stored_ - at)));
    file_.read(at, part.data(), part.size());
    target.write(part);
  }
  target.write(buffer_);
}

}  // namespace atlas
