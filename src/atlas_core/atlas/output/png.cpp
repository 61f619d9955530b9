// SPDX-License-Identifier: MIT
#include "atlas/output/png.hpp"

#include <libdeflate.h>
#include <png.h>

#include <memory>
#include <new>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace atlas {
namespace {

constexpr int kLevel = 1;  // the fastest; higher ones gain little on depth and thermal images

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};
struct Packed {
  std::unique_ptr<std::uint8_t[]> bytes;
  std::size_t size = 0;
};

/// One row as PNG stores it: the high byte of 16 bits first.
void storeRow(const cv::Mat& image, int row, std::vector<std::uint8_t>& stored) {
  if (image.depth() == CV_8U) {
    stored.assign(image.ptr<std::uint8_t>(row), image.ptr<std::uint8_t>(row) + stored.size());
    return;
  }
  const auto* value = image.ptr<std::uint16_t>(row);
  for (std::size_t i = 0; i < stored.size() / 2; ++i) {
    stored[2 * i] = static_cast<std::uint8_t>(value[i] >> 8U);
    stored[2 * i + 1] = static_cast<std::uint8_t>(value[i]);
  }
}

/// All rows, each as its difference from the one above (filter "up").
std::vector<std::uint8_t> filtered(const cv::Mat& image) {
  const std::size_t bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
  std::vector<std::uint8_t> row(bytes), above(bytes, 0);
  std::vector<std::uint8_t> result((bytes + 1) * static_cast<std::size_t>(image.rows));
  std::uint8_t* to = result.data();
  for (int r = 0; r < image.rows; ++r) {
    storeRow(image, r, row);
    *to++ = PNG_FILTER_VALUE_UP;
    for (std::size_t i = 0; i < bytes; ++i) to[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    to += bytes;
    std::swap(row, above);
  }
  return result;
}

Packed pack(const std::vector<std::uint8_t>& bytes) {
  const std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(
      libdeflate_alloc_compressor(kLevel));
  if (!compressor) throw std::bad_alloc();
  const std::size_t most = libdeflate_zlib_compress_bound(compressor.get(), bytes.size());
  Packed packed{std::unique_ptr<std::uint8_t[]>(new std::uint8_t[most])};
  packed.size =
      libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), packed.bytes.get(), most);
  return packed;
}

[[noreturn]] void fail(png_structp /*png*/, png_const_charp message) {
  throw std::runtime_error(std::string("PNG: ") + message);
}
void append(png_structp png, png_bytep data, std::size_t size) {
  auto* bytes = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes->insert(bytes->end(), data, data + size);
}

/// What libpng needs to write chunks, as long as it lives.
class ChunkWriter {
 public:
  explicit ChunkWriter(std::vector<std::uint8_t>& to)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr)),
        info_(png_ ? png_create_info_struct(png_) : nullptr) {
    if (!info_) throw std::bad_alloc();
    png_set_write_fn(png_, &to, append, nullptr);
  }
  ~ChunkWriter() { png_destroy_write_struct(&png_, &info_); }
  ChunkWriter(const ChunkWriter&) = delete;
  ChunkWriter& operator=(const ChunkWriter&) = delete;

  void begin(const cv::Mat& image) {
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(image.cols), static_cast<png_uint_32>(image.rows),
                 static_cast<int>(8 * image.elemSize1()),
                 image.channels() == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
  }
  void chunk(const char* name, const std::uint8_t* data, std::size_t size) {
    png_write_chunk(png_, reinterpret_cast<png_const_bytep>(name), data, size);
  }

 private:
  png_structp png_;
  png_infop info_;
};

}  // namespace

std::vector<std::uint8_t> encodePng(const cv::Mat& image) {
  if (image.empty()) throw std::invalid_argument("PNG: image must have pixels, got 0 x 0");
  if (image.type() != CV_8UC1 && image.type() != CV_16UC1 && image.type() != CV_8UC3) {
    throw std::invalid_argument("PNG: pixels must be grey of 8 or 16 bits or color of 8, got OpenCV's type " +
                                std::to_string(image.type()));
  }
  cv::Mat stored;  // the caller's pixels stay as they are
  if (image.channels() == 3) {
    cv::cvtColor(image, stored, cv::COLOR_BGR2RGB);
  } else {
    stored = image;
  }
  const Packed packed = pack(filtered(stored));
  std::vector<std::uint8_t> png;
  png.reserve(packed.size + 100);  // and the other chunks
  ChunkWriter writer(png);
  writer.begin(stored);
  writer.chunk("IDAT", packed.bytes.get(), packed.size);
  writer.chunk("IEND", nullptr, 0);
  return png;
}

}  // namespace atlas
