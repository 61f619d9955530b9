// SPDX-License-Identifier: MIT
#include "atlas/output/png.hpp"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "atlas/output/run_deflate.hpp"

namespace atlas {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Filter types of the PNG specification, 9.2. Depth and temperatures of 16 bits come out smaller as
// differences to the pixel on the left, pictures as differences to the row above.
constexpr std::uint8_t kSub = 1, kUp = 2;

void append(Bytes& bytes, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void appendChunk(Bytes& bytes, const std::string& type, const Bytes& data) {
  append(bytes, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = bytes.size();
  bytes.insert(bytes.end(), type.begin(), type.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  append(bytes, static_cast<std::uint32_t>(crc32_z(0, bytes.data() + begin, bytes.size() - begin)));
}

/// A row as PNG stores it: RGB, the higher byte first.
void storeRow(const cv::Mat& image, int row, std::uint8_t* to) {
  const std::uint8_t* from = image.ptr(row);
  if (image.type() == CV_8UC1) {
    std::copy(from, from + image.cols, to);
  } else if (image.type() == CV_8UC3) {
    for (int i = 0; i < image.cols; ++i, to += 3, from += 3)
      to[0] = from[2], to[1] = from[1], to[2] = from[0];
  } else {
    const std::uint16_t* value = image.ptr<std::uint16_t>(row);
    for (int i = 0; i < image.cols; ++i, to += 2) {
      to[0] = static_cast<std::uint8_t>(value[i] >> 8U);
      to[1] = static_cast<std::uint8_t>(value[i]);
    }
  }
}

/// Every row with the filter's number before it.
Bytes filtered(const cv::Mat& image) {
  const std::size_t pixel = image.elemSize(), size = pixel * static_cast<std::size_t>(image.cols);
  const std::uint8_t filter = image.type() == CV_16UC1 ? kSub : kUp;
  // Before each row lies what the filter subtracts where there is nothing: zeros on its left, or a row of
  // zeros.
  Bytes above(pixel + size, 0), here(pixel + size, 0),
      result((1 + size) * static_cast<std::size_t>(image.rows));
  std::uint8_t* to = result.data();
  for (int row = 0; row < image.rows; ++row) {
    storeRow(image, row, here.data() + pixel);
    const std::uint8_t* value = here.data() + pixel;
    const std::uint8_t* predicted = filter == kSub ? here.data() : above.data() + pixel;
    *to++ = filter;
    for (std::size_t i = 0; i < size; ++i) to[i] = static_cast<std::uint8_t>(value[i] - predicted[i]);
    to += size;
    std::swap(above, here);
  }
  return result;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const cv::Mat& image) {
  if (image.empty()) throw std::invalid_argument("PNG: image must have pixels, got 0 x 0");
  const int type = image.type();
  if (type != CV_8UC1 && type != CV_16UC1 && type != CV_8UC3) {
    throw std::invalid_argument("PNG: image must be grey of 8 or 16 bits or BGR of 8, got OpenCV's type " +
                                std::to_string(type));
  }
  Bytes header;
  append(header, static_cast<std::uint32_t>(image.cols));
  append(header, static_cast<std::uint32_t>(image.rows));
  const std::uint8_t bits = type == CV_16UC1 ? 16 : 8, colour = type == CV_8UC3 ? 2 : 0;
  header.insert(header.end(), {bits, colour, 0, 0, 0});  // deflate, the five filters, not interlaced
  Bytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  appendChunk(bytes, "IHDR", header);
  appendChunk(bytes, "IDAT", runDeflate(filtered(image)));
  appendChunk(bytes, "IEND", {});
  return bytes;
}

}  // namespace atlas
