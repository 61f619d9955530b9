// SPDX-License-Identifier: MIT
// Packets of a video file (mp4) as recorded, without decoding: Annex-B data in decoding order with the place
// of each picture in presentation order. Stamps are not in the video; they come from timestamps.txt.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// pts_index of a packet that is there for decoding only: its picture is outside of the requested span, or
/// its place is unknown because the file is cut.
inline constexpr std::uint32_t kNoPicture = 0xffffffff;

class VideoFile {
 public:
  /// Throws std::runtime_error "<path>: ..." when the file is no readable video.
  explicit VideoFile(const std::filesystem::path& path);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  [[nodiscard]] const std::string& codec() const;  ///< "hevc", "h264", "mpeg4", ...
  [[nodiscard]] std::uint32_t width() const;
  [[nodiscard]] std::uint32_t height() const;
  /// Pictures in the file: those whose bytes are there, even if the file was cut.
  [[nodiscard]] std::uint32_t frames() const;
  /// Pictures that the index of the file lists but whose bytes are missing (cut file).
  [[nodiscard]] std::uint32_t missingFrames() const;

  /// The next packet without stamp and frame; nullopt at the end or when the rest is unreadable. Memory: the
  /// few packets between a picture and those shown before it.
  std::optional<VideoPacket> next();
  /// Continues at the last keyframe at or before a packet; keeps decode_index and pts_index as from the
  /// start. Forwards or backwards. Without an index in the file it starts from the beginning.
  void seek(std::uint32_t decode_index);

 private:
  class Demuxer;
  std::unique_ptr<Demuxer> demuxer_;
};

}  // namespace atlas
