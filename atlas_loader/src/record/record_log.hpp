// SPDX-License-Identifier: MIT
// The book of a record: what became of every row of every file, and notes for the user. Shared by the sources
// of one reader. Bounded: reasons are few and examples are kept for the first rows only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "atlas/sensor/record_reader.hpp"

namespace atlas::record {

class RecordLog {
 public:
  /// The report of a file, made on first use; the reference stays valid.
  FileReport& file(const std::string& name) { return files_[name]; }
  /// Counts rows of `file` as skipped; `example` ("" = none) is kept when it is among the first few.
  void skip(const std::string& file, const std::string& reason, const std::string& example = "",
            std::uint64_t rows = 1);
  void note(const std::string& text);

  [[nodiscard]] const std::map<std::string, FileReport>& files() const { return files_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::map<std::string, FileReport> files_;
  std::vector<std::string> notes_;
};

/// Reasons that several files share.
inline constexpr const char* kOutsideSpan = "outside the requested time span";
inline constexpr const char* kBeyondReorder = "stamp goes back beyond the reorder window";

}  // namespace atlas::record
