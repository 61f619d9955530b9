// SPDX-License-Identifier: MIT
#include "record/pcd.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "record/text_rows.hpp"

namespace atlas::record {
namespace {
constexpr std::size_t kMaxPoints =
    20'000'000;  // far above any lidar's revolution: a larger header is damaged

struct Field {
  std::string name;
  std::size_t size = 4, count = 1;
  char type = 'F';
  std::size_t offset = 0;  ///< bytes in a record; for compressed data offset of the column per point
  std::size_t column = 0;  ///< first column of an ascii row
};

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0, record_bytes = 0, columns = 0;
  std::string data;
  std::size_t body = 0;  ///< offset of the data
  std::string error;
};

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> out;
  for (text = trim(text); !text.empty(); text = trim(text)) {
    const std::size_t end = text.find_first_of(" \t");
    out.push_back(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end);
  }
  return out;
}

/// Applies one header line; false when a number is missing or wrong.
bool applyHeaderLine(const std::vector<std::string_view>& word, Header& header, std::size_t& width,
                     std::size_t& height) {
  const auto number = [&word](std::size_t i) { return i < word.size() ? toUnsigned(word[i]) : std::nullopt; };
  if (word[0] == "FIELDS" || word[0] == "COLUMNS") {
    for (std::size_t i = 1; i < word.size(); ++i) {
      Field field;
      field.name = std::string(word[i]);
      header.fields.push_back(field);
    }
  } else if (word[0] == "SIZE" || word[0] == "COUNT" || word[0] == "TYPE") {
    if (word.size() != header.fields.size() + 1) return false;
    for (std::size_t i = 1; i < word.size(); ++i) {
      Field& field = header.fields[i - 1];
      if (word[0] == "TYPE") {
        field.type = word[i][0];
        continue;
      }
      const auto value = number(i);
      if (!value || *value == 0 || *value > 1024) return false;
      (word[0] == "SIZE" ? field.size : field.count) = static_cast<std::size_t>(*value);
    }
  } else if (word[0] == "WIDTH" || word[0] == "HEIGHT" || word[0] == "POINTS") {
    const auto value = number(1);
    if (!value || *value > kMaxPoints) return false;
    (word[0] == "WIDTH"    ? width
     : word[0] == "HEIGHT" ? height
                           : header.points) = static_cast<std::size_t>(*value);
  }
  return true;
}

Header parseHeader(std::string_view bytes) {
  Header header;
  std::size_t width = 0, height = 1, at = 0;
  while (header.data.empty()) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos || at > 65536) {
      header.error = "no PCD header";
      return header;
    }
    const std::string_view text = trim(bytes.substr(at, end - at));
    at = end + 1;
    const auto word = words(text);
    if (word.empty() || word[0][0] == '#') continue;
    if (!applyHeaderLine(word, header, width, height)) {
      header.error = "bad PCD header line '" + std::string(text.substr(0, 60)) + "'";
      return header;
    }
    if (word[0] == "DATA" && word.size() > 1) header.data = std::string(word[1]);
  }
  header.body = at;
  if (header.points == 0 && width <= kMaxPoints / std::max<std::size_t>(height, 1))
    header.points = width * height;
  for (Field& field : header.fields) {
    field.offset = header.record_bytes;
    field.column = header.columns;
    header.record_bytes += field.size * field.count;
    header.columns += field.count;
  }
  return header;
}

template <class T>
double load(const char* data) {
  T value;
  std::memcpy(&value, data, sizeof(T));
  return static_cast<double>(value);
}

double decodeRare(const Field& field, const char* data) {
  switch (field.type) {
    case 'F':
      return load<double>(data);
    case 'U':
      return field.size == 8   ? load<std::uint64_t>(data)
             : field.size == 4 ? load<std::uint32_t>(data)
             : field.size == 2 ? load<std::uint16_t>(data)
                               : load<std::uint8_t>(data);
    default:
      return field.size == 8   ? load<std::int64_t>(data)
             : field.size == 4 ? load<std::int32_t>(data)
             : field.size == 2 ? load<std::int16_t>(data)
                               : load<std::int8_t>(data);
  }
}

/// Nearly all fields are of four bytes with a point: no call for them.
inline double decode(const Field& field, const char* data) {
  return field.type == 'F' && field.size == 4 ? load<float>(data) : decodeRare(field, data);
}

bool isDecodable(const Field& field) {
  if (field.type == 'F') return field.size == 4 || field.size == 8;
  return (field.type == 'U' || field.type == 'I') &&
         (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8);
}

/// Fields by their role; nullptr when the file has none.
struct Roles {
  const Field *x = nullptr, *y = nullptr, *z = nullptr, *intensity = nullptr, *ring = nullptr,
              *time = nullptr;
};

Roles findRoles(const Header& header) {
  Roles roles;
  for (const Field& field : header.fields) {
    if (!isDecodable(field)) continue;
    if (field.name == "x") roles.x = &field;
    if (field.name == "y") roles.y = &field;
    if (field.name == "z") roles.z = &field;
    if (field.name == "intensity" || field.name == "i" || field.name == "reflectivity")
      roles.intensity = &field;
    if (field.name == "ring" || field.name == "line") roles.ring = &field;
    if (field.name == "time" || field.name == "t" || field.name == "timestamp" || field.name == "offset_time")
      roles.time = &field;
  }
  return roles;
}

/// Fills the cloud with value(field, point index).
template <class Value>
void fillCloud(const Header& header, const Roles& roles, Value value, PcdCloud& cloud) {
  cloud.points.resize(header.points);
  cloud.has_ring = roles.ring != nullptr;
  if (roles.time) cloud.time_s.resize(header.points);
  const double unit_s = roles.time && roles.time->type != 'F' ? 1e-9 : 1.0;
  for (std::size_t i = 0; i < header.points; ++i) {
    LidarPoint& point = cloud.points[i];
    point.x = static_cast<float>(value(*roles.x, i));
    point.y = static_cast<float>(value(*roles.y, i));
    point.z = static_cast<float>(value(*roles.z, i));
    if (roles.intensity) point.intensity = static_cast<float>(value(*roles.intensity, i));
    if (roles.ring) point.ring = static_cast<std::uint16_t>(std::clamp(value(*roles.ring, i), 0.0, 65535.0));
    if (roles.time) cloud.time_s[i] = value(*roles.time, i) * unit_s;
  }
  // Seconds since 1970 are above 1e8, offsets within a scan far below; a double in ns (1e17 and more) is Unix
  // time too.
  const auto known = std::find_if(cloud.time_s.begin(), cloud.time_s.end(),
                                  [](double t) { return std::isfinite(t) && t != 0.0; });
  if (known == cloud.time_s.end()) return;
  const double scale = std::abs(*known) > 1e15 ? 1e-9 : 1.0;
  cloud.absolute_time = std::abs(*known) * scale > 1e8;
  for (double& t : cloud.time_s) t *= scale;
}

bool parseAscii(std::string_view body, Header& header, const Roles& roles, PcdCloud& cloud) {
  std::vector<double> table;
  table.reserve(header.points * header.columns);
  for (std::size_t row = 0; row < header.points;) {
    if (body.empty()) return false;
    const std::size_t end = body.find('\n');
    const auto word = words(body.substr(0, end));
    body.remove_prefix(end == std::string_view::npos ? body.size() : end + 1);
    if (word.empty()) continue;
    if (word.size() < header.columns) return false;
    for (std::size_t c = 0; c < header.columns; ++c)
      table.push_back(toDouble(word[c]).value_or(std::numeric_limits<double>::quiet_NaN()));
    ++row;
  }
  const auto value = [&](const Field& field, std::size_t i) {
    return table[i * header.columns + field.column];
  };
  fillCloud(header, roles, value, cloud);
  return true;
}

bool parseCompressed(std::string_view body, const Header& header, const Roles& roles, PcdCloud& cloud) {
  std::uint32_t compressed = 0, plain = 0;
  if (body.size() < 8) return false;
  std::memcpy(&compressed, body.data(), 4);
  std::memcpy(&plain, body.data() + 4, 4);
  if (compressed > body.size() - 8 || plain != header.points * header.record_bytes) return false;
  std::string columns;
  if (!decompressLzf(body.substr(8, compressed), plain, columns)) return false;
  // structure of arrays: all x, then all y, ...
  const auto value = [&](const Field& field, std::size_t i) {
    return decode(field, columns.data() + field.offset * header.points + i * field.size * field.count);
  };
  fillCloud(header, roles, value, cloud);
  return true;
}
}  // namespace

bool decompressLzf(std::string_view input, std::size_t size, std::string& output) {
  output.clear();
  output.reserve(size);
  std::size_t at = 0;
  const auto byte = [&input](std::size_t i) { return static_cast<unsigned char>(input[i]); };
  while (at < input.size()) {
    const unsigned control = byte(at++);
    if (control < 32) {  // literal run
      const std::size_t length = control + 1;
      if (at + length > input.size() || output.size() + length > size) return false;
      output.append(input.substr(at, length));
      at += length;
      continue;
    }
    std::size_t length = control >> 5;  // back reference
    if (length == 7) {
      if (at >= input.size()) return false;
      length += byte(at++);
    }
    if (at >= input.size()) return false;
    const std::size_t distance = ((control & 31u) << 8) + byte(at++) + 1;
    length += 2;
    if (distance > output.size() || output.size() + length > size) return false;
    for (std::size_t i = 0; i < length; ++i) output.push_back(output[output.size() - distance]);
  }
  return output.size() == size;
}

PcdCloud parsePcd(std::string_view bytes) {
  PcdCloud cloud;
  Header header = parseHeader(bytes);
  const Roles roles = findRoles(header);
  cloud.error = header.error;
  if (!cloud.error.empty()) return cloud;
  if (!roles.x || !roles.y || !roles.z) {
    cloud.error = "PCD without fields x, y, z";
    return cloud;
  }
  const std::string_view body = bytes.substr(header.body);
  // A header can claim more points than the file can hold: a point needs at least two bytes a column in
  // ascii, and LZF packs at most 264 bytes into three.
  const std::size_t least = header.data == "ascii"    ? header.points * header.columns * 2 - 1
                            : header.data == "binary" ? header.points * header.record_bytes
                                                      : header.points * header.record_bytes / 100;
  bool good = header.points == 0 || body.size() >= least;
  if (header.points == 0) return cloud;
  if (good && header.data == "binary") {
    const auto value = [&](const Field& field, std::size_t i) {
      return decode(field, body.data() + i * header.record_bytes + field.offset);
    };
    fillCloud(header, roles, value, cloud);
  } else if (good && header.data == "ascii") {
    good = parseAscii(body, header, roles, cloud);
  } else if (good && header.data == "binary_compressed") {
    good = parseCompressed(body, header, roles, cloud);
  } else if (good) {
    cloud.error = "unknown PCD DATA '" + header.data.substr(0, 40) + "'";
  }
  if (!good) {
    cloud = PcdCloud{};
    cloud.error = "PCD data cut or damaged";
  }
  return cloud;
}

}  // namespace atlas::record
