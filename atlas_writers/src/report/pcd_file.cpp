// SPDX-License-Identifier: MIT
#include "report/pcd_file.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace atlas::report {
namespace {

constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

struct Field {
  std::string name;
  std::size_t size = 4, count = 1;
  char type = 'F';
};

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0;
  std::string data;
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

Header readHeader(std::istream& file, const std::filesystem::path& path) {
  Header header;
  std::size_t width = 0, height = 1;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "FIELDS") {
      for (std::string name; words >> name;) header.fields.push_back({name, 4, 1, 'F'});
    } else if (key == "SIZE") {
      for (Field& field : header.fields) words >> field.size;
    } else if (key == "TYPE") {
      for (Field& field : header.fields) words >> field.type;
    } else if (key == "COUNT") {
      for (Field& field : header.fields) words >> field.count;
    } else if (key == "WIDTH") {
      words >> width;
    } else if (key == "HEIGHT") {
      words >> height;
    } else if (key == "POINTS") {
      words >> header.points;
    } else if (key == "DATA") {
      words >> header.data;
      break;
    }
  }
  if (header.points == 0) header.points = width * height;
  if (header.data != "ascii" && header.data != "binary")
    fail(path, "DATA must be ascii or binary, got '" + header.data + "'");
  return header;
}

/// Offset of x, y, z: bytes in binary, words in ascii.
std::array<std::size_t, 3> offsets(const Header& header, const std::filesystem::path& path,
                                   std::size_t& stride) {
  std::array<std::size_t, 3> result{kAbsent, kAbsent, kAbsent};
  stride = 0;
  for (const Field& field : header.fields) {
    const std::size_t axis = field.name == "x" ? 0 : field.name == "y" ? 1 : field.name == "z" ? 2 : 3;
    if (axis < 3) {
      if (field.type != 'F' || field.size != 4 || field.count != 1)
        fail(path, "field " + field.name + " is not one 4-byte float");
      result[axis] = stride;
    }
    stride += header.data == "binary" ? field.size * field.count : field.count;
  }
  for (const std::size_t offset : result) {
    if (offset == kAbsent) fail(path, "no fields x y z");
  }
  return result;
}

void keepFinite(const cv::Point3f& p, std::vector<cv::Point3f>& points) {
  if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) points.push_back(p);
}

}  // namespace

std::vector<cv::Point3f> readPcd(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "cannot be read");
  const Header header = readHeader(file, path);
  std::size_t stride = 0;
  const auto offset = offsets(header, path, stride);
  std::vector<cv::Point3f> points;
  if (header.data == "ascii") {
    std::vector<float> row(stride);
    for (std::string line; points.size() < header.points && std::getline(file, line);) {
      std::istringstream words(line);
      std::string word;
      for (float& value : row) value = words >> word ? std::strtof(word.c_str(), nullptr) : std::nanf("");
      keepFinite({row[offset[0]], row[offset[1]], row[offset[2]]}, points);
    }
    return points;
  }
  std::vector<char> row(stride);
  for (std::size_t i = 0; i < header.points; ++i) {
    if (!file.read(row.data(), static_cast<std::streamsize>(stride))) {
      fail(path, "ends after " + std::to_string(i) + " of " + std::to_string(header.points) + " points");
    }
    cv::Point3f p;
    std::memcpy(&p.x, row.data() + offset[0], 4);
    std::memcpy(&p.y, row.data() + offset[1], 4);
    std::memcpy(&p.z, row.data() + offset[2], 4);
    keepFinite(p, points);
  }
  return points;
}

}  // namespace atlas::report
