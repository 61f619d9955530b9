// SPDX-License-Identifier: MIT
// H.265 in mp4 through libavcodec (libx265), one thread, bit-exact: the same pictures give the same file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace atlas::synthetic {

class VideoEncoder {
 public:
  /// Throws std::runtime_error when libx265 is not there or the file cannot be written. Width and height are
  /// even.
  VideoEncoder(const std::filesystem::path& file, int width, int height, int frames_per_second);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;
  /// RGB, 3 bytes a pixel.
  void addRgb(const std::vector<std::uint8_t>& rgb);
  /// Grey as a colour video without colour: full-range grey g becomes limited-range luma, as a decoder undoes
  /// it.
  void addGrey(const std::vector<std::uint8_t>& grey);
  void close();

 private:
  struct Codec;
  void encode(bool flush);
  std::unique_ptr<Codec> codec_;
};

}  // namespace atlas::synthetic
