// SPDX-License-Identifier: MIT
#include "atlas/output/pcd.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <optional>
#include <sstream>

namespace atlas {
namespace {

constexpr std::size_t kFloats = 5;                                                ///< x y z intensity time
constexpr std::size_t kRecord = kFloats * sizeof(float) + sizeof(std::uint16_t);  ///< bytes a point
static_assert(offsetof(LidarPoint, ring) == kFloats * sizeof(float),
              "a LidarPoint begins as its record does");

std::string header(const char* fields, const char* sizes, const char* types, const char* counts,
                   std::uint64_t points) {
  const std::string n = std::to_string(points);
  return std::string("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS ") + fields +
         "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " + n +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n";
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

std::optional<std::size_t> wholeNumber(const std::string& text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// What the header says about the records.
struct Layout {
  std::vector<std::string> fields, sizes, types, counts;
  std::size_t points = 0, data_begin = 0;

  /// Offset of a field in a record; nothing when it is absent or of another type.
  [[nodiscard]] std::optional<std::size_t> offsetOf(const std::string& name, const std::string& type,
                                                    const std::string& size) const {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i] == name) {
        if (types[i] != type || sizes[i] != size || counts[i] != "1") return std::nullopt;
        return offset;
      }
      offset += *wholeNumber(sizes[i]) * *wholeNumber(counts[i]);
    }
    return std::nullopt;
  }
};

/// Record length; nothing when a number is missing or makes no sense.
std::optional<std::size_t> recordSize(const Layout& layout) {
  const std::size_t n = layout.fields.size();
  if (n == 0 || layout.sizes.size() != n || layout.types.size() != n || layout.counts.size() != n)
    return std::nullopt;
  std::size_t record = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto size = wholeNumber(layout.sizes[i]), count = wholeNumber(layout.counts[i]);
    if (!size || !count || *size > 8 || *count > 100000) return std::nullopt;
    record += *size * *count;
  }
  return record == 0 ? std::nullopt : std::optional<std::size_t>(record);
}

std::optional<Layout> parseHeader(const std::string& bytes) {
  Layout layout;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = bytes.find('\n', begin);
    if (end == std::string::npos) return std::nullopt;
    std::vector<std::string> line = words(bytes.substr(begin, end - begin));
    begin = end + 1;
    if (line.empty() || line[0][0] == '#') continue;
    const std::string key = line[0];
    line.erase(line.begin());
    if (key == "FIELDS") layout.fields = line;
    if (key == "SIZE") layout.sizes = line;
    if (key == "TYPE") layout.types = line;
    if (key == "COUNT") layout.counts = line;
    if (key == "POINTS") {
      const auto points = line.size() == 1 ? wholeNumber(line[0]) : std::nullopt;
      if (!points) return std::nullopt;
      layout.points = *points;
    }
    if (key != "DATA") continue;
    if (line.size() != 1 || line[0] != "binary") return std::nullopt;
    layout.data_begin = begin;
    return layout;
  }
}

template <class T>
void copyField(T& field, const char* record, std::optional<std::size_t> offset) {
  if (offset) std::memcpy(&field, record + *offset, sizeof(T));
}

}  // namespace

std::string encodePcd(const std::vector<LidarPoint>& points) {
  std::string bytes =
      header("x y z intensity time ring", "4 4 4 4 4 2", "F F F F F U", "1 1 1 1 1 1", points.size());
  std::size_t at = bytes.size();
  bytes.resize(at + kRecord * points.size());
  for (const LidarPoint& point : points) {
    std::memcpy(&bytes[at], &point, kRecord);  // the first 22 of 24 bytes
    at += kRecord;
  }
  return bytes;
}

Outcome<std::vector<LidarPoint>> decodePcd(const std::string& bytes) {
  const std::optional<Layout> layout = parseHeader(bytes);
  if (!layout) return Reason::kBadLayout;
  const std::optional<std::size_t> record = recordSize(*layout);
  if (!record || layout->points > (bytes.size() - layout->data_begin) / *record) return Reason::kBadLayout;
  const auto x = layout->offsetOf("x", "F", "4"), y = layout->offsetOf("y", "F", "4"),
             z = layout->offsetOf("z", "F", "4");
  if (!x || !y || !z) return Reason::kBadLayout;
  const auto intensity = layout->offsetOf("intensity", "F", "4"), time = layout->offsetOf("time", "F", "4"),
             ring = layout->offsetOf("ring", "U", "2");
  std::vector<LidarPoint> points(layout->points);
  const char* at = bytes.data() + layout->data_begin;
  for (LidarPoint& point : points) {
    copyField(point.x, at, x);
    copyField(point.y, at, y);
    copyField(point.z, at, z);
    copyField(point.intensity, at, intensity);
    copyField(point.time, at, time);
    copyField(point.ring, at, ring);
    at += *record;
  }
  return points;
}

std::string mapPcdHeader(std::uint64_t points, bool coloured) {
  if (coloured)
    return header("x y z intensity count rgb", "4 4 4 4 4 4", "F F F F U F", "1 1 1 1 1 1", points);
  return header("x y z intensity count", "4 4 4 4 4", "F F F F U", "1 1 1 1 1", points);
}

std::string mapRecords(const std::vector<MapPoint>& points, bool coloured) {
  const std::size_t record = coloured ? sizeof(MapPoint) : offsetof(MapPoint, colour);
  std::string bytes(record * points.size(), '\0');
  for (std::size_t i = 0; i < points.size(); ++i) std::memcpy(&bytes[record * i], &points[i], record);
  return bytes;
}

}  // namespace atlas
