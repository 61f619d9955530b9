// SPDX-License-Identifier: MIT
// Rows of text files: CRLF or LF, blanks around fields, lines of any length, without trusting any of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atlas/base/time.hpp"

namespace atlas::record {

/// One line without its line end. `text` is valid until the next call.
struct Line {
  std::string_view text;
  std::uint64_t number = 0;  ///< 1-based
  std::uint64_t offset = 0;  ///< of its first byte in the file
  bool too_long = false;     ///< cut: longer than kMaxLine
};

/// Reads a file line by line in fixed memory.
class LineReader {
 public:
  static constexpr std::size_t kMaxLine = 1u << 16;  ///< bytes; a radar row of 500 targets has about 16 kB

  explicit LineReader(const std::filesystem::path& path);
  [[nodiscard]] bool opened() const { return opened_; }
  std::optional<Line> next();
  /// Continues at a byte offset that next() has given; line numbers go on from `number`.
  void seek(std::uint64_t offset, std::uint64_t number);

 private:
  std::optional<Line> finish(bool too_long);

  std::ifstream file_;
  bool opened_ = false;
  std::vector<char> chunk_;
  std::size_t used_ = 0, filled_ = 0;
  std::uint64_t offset_ = 0, line_ = 0, line_offset_ = 0;
  std::string text_;
};

/// True for a line of blanks only.
bool isBlank(std::string_view text);
std::string_view trim(std::string_view text);
/// Locale-independent; nullopt when the text is not wholly one number.
std::optional<double> toDouble(std::string_view text);
std::optional<std::int64_t> toInteger(std::string_view text);
std::optional<std::uint64_t> toUnsigned(std::string_view text);

/// Fields of one row. The first fault is remembered; later reads return 0 and are not to be used: check ok().
class RowFields {
 public:
  /// delimiter ' ' = any number of blanks.
  RowFields(const std::string& file, char delimiter) : file_(file), delimiter_(delimiter) {}

  void assign(const Line& line);
  [[nodiscard]] std::size_t size() const { return fields_.size(); }
  /// The field as it stands; "" beyond the last.
  [[nodiscard]] std::string_view text(std::size_t index) const {
    return index < fields_.size() ? fields_[index] : std::string_view();
  }
  /// Needs exactly `count` fields.
  bool expect(std::size_t count);
  bool expectAtLeast(std::size_t count);
  /// Unix time in ns between the years 2000 and 2100.
  Stamp stamp(std::size_t index);
  /// A finite number.
  double number(std::size_t index, const char* name);
  std::int64_t integer(std::size_t index, const char* name, std::int64_t minimum, std::int64_t maximum);
  std::uint64_t unsignedInteger(std::size_t index, const char* name);
  /// Six integer fields year..second and one of ns from `first`, as UTC.
  Stamp calendar(std::size_t first);
  void fail(const std::string& reason, const std::string& detail);

  [[nodiscard]] bool ok() const { return reason_.empty(); }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// "imu/imu.txt:17: field 3 (ay): not a number: 'abc'"
  [[nodiscard]] std::string example() const;
  [[nodiscard]] std::uint64_t line() const { return line_; }

 private:
  std::string_view field(std::size_t index, const char* name);
  void failField(std::size_t index, const char* name, const std::string& reason);

  std::string file_;
  char delimiter_;
  std::vector<std::string_view> fields_;
  std::uint64_t line_ = 0;
  std::string reason_, detail_;
};

/// UTC calendar to Unix time, ns; nullopt for what is no date (month 13, second 61).
std::optional<Stamp> fromCalendar(std::int64_t year, std::int64_t month, std::int64_t day, std::int64_t hour,
                                  std::int64_t minute, std::int64_t second, std::int64_t nanosecond);
/// Unix time in ns that a recording can have: years 2000 to 2100.
bool isPlausible(Stamp stamp);

}  // namespace atlas::record
