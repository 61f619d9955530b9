// SPDX-License-Identifier: MIT
// Small H.265 videos whose frames can be told apart: frame k is grey 20 + 10 k (grey) or a known colour.
#pragma once

#include <filesystem>

#include "small_record.hpp"
#include "synthetic/video_encoder.hpp"

namespace atlas::test {

inline constexpr int kVideoWidth = 96, kVideoHeight = 64;
inline std::uint8_t greyOfFrame(int k) { return static_cast<std::uint8_t>(20 + 10 * (k % 20)); }

inline void writeGreyVideo(const std::filesystem::path& file, int frames) {
  std::filesystem::create_directories(file.parent_path());
  synthetic::VideoEncoder encoder(file, kVideoWidth, kVideoHeight, 10);
  for (int k = 0; k < frames; ++k)
    encoder.addGrey(std::vector<std::uint8_t>(kVideoWidth * kVideoHeight, greyOfFrame(k)));
  encoder.close();
}

inline void writeRgbVideo(const std::filesystem::path& file, int frames, std::array<std::uint8_t, 3> rgb) {
  std::filesystem::create_directories(file.parent_path());
  synthetic::VideoEncoder encoder(file, kVideoWidth, kVideoHeight, 10);
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < kVideoWidth * kVideoHeight; ++i) pixels.insert(pixels.end(), rgb.begin(), rgb.end());
  for (int k = 0; k < frames; ++k) encoder.addRgb(pixels);
  encoder.close();
}

/// The same mp4 with its index (moov) before the pictures, as some recorders write it; "" when it is no such
/// file.
inline std::string withIndexFirst(std::string mp4) {
  const auto number = [&mp4](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(mp4[at + i]);
    return value;
  };
  std::size_t data = 0, index = 0;
  for (std::size_t at = 0; at + 8 <= mp4.size() && number(at) >= 8; at += number(at)) {
    if (mp4.compare(at + 4, 4, "mdat") == 0) data = at;
    if (mp4.compare(at + 4, 4, "moov") == 0) index = at;
  }
  const std::size_t offsets = mp4.find("stco", index);
  if (data == 0 || index < data || offsets == std::string::npos) return "";
  const std::uint32_t size = number(index);
  for (std::size_t i = 0; i < number(offsets + 8); ++i) {  // places of the pictures in the file
    const std::size_t at = offsets + 12 + 4 * i;
    const std::uint32_t moved = number(at) + size;
    for (std::size_t b = 0; b < 4; ++b) mp4[at + b] = static_cast<char>(moved >> (24 - 8 * b));
  }
  const std::string moov = mp4.substr(index, size);
  mp4.erase(index, size);
  return mp4.insert(data, moov);
}

/// camera_ir with its video and camera_left_front with detections, `frames` each at 10 Hz.
inline void addCameras(const TemporaryFolder& folder, int frames) {
  const Duration period = 100 * kMillisecond;
  folder.write("camera_ir/timestamps.txt",
               rows(frames, period, [](int i) { return "," + std::to_string(i) + ",-29.65,20.74"; }));
  writeGreyVideo(folder / "camera_ir/video.mp4", frames);
  folder.write("camera_left_front/timestamps.txt",
               rows(
                   frames, period, [](int i) { return "," + std::to_string(i) + ", 11851675248"; }, "\n"));
  writeRgbVideo(folder / "camera_left_front/video.mp4", frames, {200, 80, 40});
  folder.write("yolo/camera_left_front.txt",
               "2, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n1, 0.25, 0.5, 0.1, 0.1, 0.8, 0\n"
               "2, 0.75, 0.5, 0.1, 0.1, 0.7, 7");
}

}  // namespace atlas::test
