// SPDX-License-Identifier: MIT
#include "record/record_log.hpp"

#include <algorithm>

namespace atlas::record {
namespace {
constexpr std::size_t kExamples = 5;  // per file: enough to find the fault, short enough for a summary
constexpr std::size_t kNotes = 1000;
}  // namespace

void RecordLog::skip(const std::string& file, const std::string& reason, const std::string& example,
                     std::uint64_t rows) {
  if (rows == 0) return;
  FileReport& report = files_[file];
  report.skipped[reason] += rows;
  if (!example.empty() && report.examples.size() < kExamples) report.examples.push_back(example);
}

void RecordLog::note(const std::string& text) {
  if (notes_.size() >= kNotes) return;
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

}  // namespace atlas::record
