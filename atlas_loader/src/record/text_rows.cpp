// SPDX-License-Identifier: MIT
#include "record/text_rows.hpp"

#include <charconv>
#include <cmath>
#include <locale>
#include <sstream>

namespace atlas::record {
namespace {
constexpr Stamp kYear2000 = 946'684'800 * kSecond;
constexpr Stamp kYear2100 = 4'102'444'800 * kSecond;
constexpr std::size_t kChunk = 1u << 16;

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

template <class T>
std::optional<T> parseWhole(std::string_view text) {
  T value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || result.ec != std::errc() || result.ptr != text.data() + text.size())
    return std::nullopt;
  return value;
}

std::string_view withoutPlus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

/// Days since 1970-01-01 of a date in the Gregorian calendar (H. Hinnant, "chrono-compatible low-level date
/// algorithms").
std::int64_t daysFromCivil(std::int64_t y, std::int64_t m, std::int64_t d) {
  y -= m <= 2 ? 1 : 0;
  const std::int64_t era = (y >= 0 ? y : y - 399) / 400;
  const std::int64_t yoe = y - era * 400;
  const std::int64_t doy = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
  const std::int64_t doe = yoe * 365 + yoe / 4 - yoe / 100 + doy;
  return era * 146097 + doe - 719468;
}

std::int64_t daysInMonth(std::int64_t year, std::int64_t month) {
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  if (month == 2) return leap ? 29 : 28;
  return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

/// What a message may show of a field: printable and short.
std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  if (text.size() > 40) out += "...";
  return out;
}
}  // namespace

LineReader::LineReader(const std::filesystem::path& path) : file_(path, std::ios::binary), chunk_(kChunk) {
  std::error_code error;
  opened_ = file_.is_open() && !std::filesystem::is_directory(path, error);
}

void LineReader::seek(std::uint64_t offset, std::uint64_t number) {
  line_ = number - 1;
  const std::uint64_t chunk_begin = offset_ - used_;
  if (offset >= chunk_begin && offset < chunk_begin + filled_) {  // still in memory
    used_ = static_cast<std::size_t>(offset - chunk_begin);
    offset_ = offset;
    return;
  }
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(offset));
  used_ = filled_ = 0;
  offset_ = offset;
}

std::optional<Line> LineReader::finish(bool too_long) {
  ++line_;
  std::string_view text = text_;
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (line_ == 1 && text.substr(0, kByteOrderMark.size()) == kByteOrderMark)
    text.remove_prefix(kByteOrderMark.size());
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return Line{text, line_, line_offset_, too_long};
}

std::optional<Line> LineReader::next() {
  if (!opened_) return std::nullopt;
  text_.clear();
  line_offset_ = offset_;
  bool too_long = false;
  while (true) {
    if (used_ == filled_) {
      file_.read(chunk_.data(), static_cast<std::streamsize>(chunk_.size()));
      used_ = 0;
      filled_ = static_cast<std::size_t>(file_.gcount());
      if (filled_ == 0) {
        if (offset_ == line_offset_) return std::nullopt;
        return finish(too_long);
      }
    }
    const std::string_view rest(chunk_.data() + used_, filled_ - used_);
    const std::size_t end = rest.find('\n');
    const std::string_view part = rest.substr(0, end);
    const std::size_t room = kMaxLine - text_.size();
    text_.append(part.substr(0, room));
    too_long = too_long || part.size() > room;
    const std::size_t consumed = part.size() + (end == std::string_view::npos ? 0 : 1);
    used_ += consumed;
    offset_ += consumed;
    if (end != std::string_view::npos) return finish(too_long);
  }
}

bool isBlank(std::string_view text) { return trim(text).empty(); }

std::string_view trim(std::string_view text) {
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> toDouble(std::string_view text) {
  text = withoutPlus(trim(text));
#if defined(__cpp_lib_to_chars)
  return parseWhole<double>(text);
#else  // GCC 9 has no std::from_chars for double
  if (text.empty()) return std::nullopt;
  std::istringstream stream{std::string(text)};
  stream.imbue(std::locale::classic());
  double value = 0;
  stream >> value;
  if (stream.fail() || stream.peek() != std::istringstream::traits_type::eof()) return std::nullopt;
  return value;
#endif
}

std::optional<std::int64_t> toInteger(std::string_view text) {
  return parseWhole<std::int64_t>(withoutPlus(trim(text)));
}

std::optional<std::uint64_t> toUnsigned(std::string_view text) {
  return parseWhole<std::uint64_t>(withoutPlus(trim(text)));
}

void RowFields::assign(const Line& line) {
  fields_.clear();
  reason_.clear();
  detail_.clear();
  line_ = line.number;
  if (line.too_long) {
    fail("line too long", "more than " + std::to_string(LineReader::kMaxLine) + " bytes");
    return;
  }
  std::string_view rest = line.text;
  if (delimiter_ == ' ') {
    for (rest = trim(rest); !rest.empty(); rest = trim(rest)) {
      const std::size_t end = rest.find_first_of(" \t");
      fields_.push_back(rest.substr(0, end));
      rest = end == std::string_view::npos ? std::string_view() : rest.substr(end);
    }
    return;
  }
  while (true) {
    const std::size_t end = rest.find(delimiter_);
    fields_.push_back(trim(rest.substr(0, end)));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (fields_.size() > 1 && fields_.back().empty()) fields_.pop_back();  // a comma at the end of the row
}

void RowFields::fail(const std::string& reason, const std::string& detail) {
  if (!ok()) return;
  reason_ = reason;
  detail_ = detail;
}

void RowFields::failField(std::size_t index, const char* name, const std::string& reason) {
  fail(reason, "field " + std::to_string(index + 1) + " (" + name + "): " + reason + ": '" +
                   shown(fields_[index]) + "'");
}

std::string RowFields::example() const { return file_ + ":" + std::to_string(line_) + ": " + detail_; }

bool RowFields::expect(std::size_t count) {
  if (!expectAtLeast(count)) return false;
  if (ok() && fields_.size() > count) {
    fail("too many fields",
         "expected " + std::to_string(count) + " fields, found " + std::to_string(fields_.size()));
  }
  return ok();
}

bool RowFields::expectAtLeast(std::size_t count) {
  if (ok() && fields_.size() < count) {
    fail("too few fields",
         "expected " + std::to_string(count) + " fields, found " + std::to_string(fields_.size()));
  }
  return ok();
}

std::string_view RowFields::field(std::size_t index, const char* name) {
  if (!ok()) return {};
  if (index >= fields_.size()) {
    fail("too few fields", "field " + std::to_string(index + 1) + " (" + name + ") is missing");
    return {};
  }
  return fields_[index];
}

Stamp RowFields::stamp(std::size_t index) {
  const std::string_view text = field(index, "stamp");
  if (!ok()) return 0;
  const auto value = toInteger(text);
  if (!value) {
    failField(index, "stamp", "not an integer");
  } else if (!isPlausible(*value)) {
    failField(index, "stamp", "not a Unix time in ns");
  }
  return value.value_or(0);
}

double RowFields::number(std::size_t index, const char* name) {
  const std::string_view text = field(index, name);
  if (!ok()) return 0;
  const auto value = toDouble(text);
  if (!value) {
    failField(index, name, "not a number");
  } else if (!std::isfinite(*value)) {
    failField(index, name, "not finite");
  }
  return value.value_or(0);
}

std::int64_t RowFields::integer(std::size_t index, const char* name, std::int64_t minimum,
                                std::int64_t maximum) {
  const std::string_view text = field(index, name);
  if (!ok()) return 0;
  auto value = toInteger(text);
  if (!value) {  // "3.0" is an integer too
    const auto real = toDouble(text);
    if (real && std::isfinite(*real) && std::abs(*real) < 1e15 && std::floor(*real) == *real) {
      value = static_cast<std::int64_t>(*real);
    }
  }
  if (!value) {
    failField(index, name, "not an integer");
  } else if (*value < minimum || *value > maximum) {
    failField(index, name, "out of range");
  }
  return value.value_or(0);
}

std::uint64_t RowFields::unsignedInteger(std::size_t index, const char* name) {
  const std::string_view text = field(index, name);
  if (!ok()) return 0;
  const auto value = toUnsigned(text);
  if (!value) failField(index, name, "not an unsigned integer");
  return value.value_or(0);
}

Stamp RowFields::calendar(std::size_t first) {
  const char* const names[] = {"year", "month", "day", "hour", "minute", "second", "nanosecond"};
  std::int64_t v[7] = {};
  for (std::size_t i = 0; i < 7; ++i) v[i] = integer(first + i, names[i], 0, 999'999'999);
  if (!ok()) return 0;
  const auto stamp = fromCalendar(v[0], v[1], v[2], v[3], v[4], v[5], v[6]);
  if (!stamp) failField(first, "date", "not a date");
  return stamp.value_or(0);
}

std::optional<Stamp> fromCalendar(std::int64_t year, std::int64_t month, std::int64_t day, std::int64_t hour,
                                  std::int64_t minute, std::int64_t second, std::int64_t nanosecond) {
  if (year < 1970 || year > 2200 || month < 1 || month > 12 || day < 1 || day > daysInMonth(year, month))
    return std::nullopt;
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59 || second < 0 || second > 60) return std::nullopt;
  if (nanosecond < 0 || nanosecond >= kSecond) return std::nullopt;
  const std::int64_t seconds = ((daysFromCivil(year, month, day) * 24 + hour) * 60 + minute) * 60 + second;
  return seconds * kSecond + nanosecond;
}

bool isPlausible(Stamp stamp) { return stamp >= kYear2000 && stamp < kYear2100; }

}  // namespace atlas::record
