// SPDX-License-Identifier: MIT
// Video packets in, pictures out, with the stamps of the pictures. Deterministic: one thread, bit-exact
// conversion. Picture i (presentation order) has the stamp of the packet with decode_index i. A packet at
// most 1 ns after the one before it brings no time of its own (its row of timestamps.txt is missing or goes
// back): its picture is decoded but not delivered.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

class VideoDecoder {
 public:
  enum class Pixels { kBgr8, kMono8 };

  struct Counts {
    std::uint64_t packets = 0;
    std::uint64_t images = 0;           ///< delivered
    std::uint64_t before_keyframe = 0;  ///< packets without a keyframe before them
    std::uint64_t undecodable = 0;      ///< packets that the decoder refused
    std::uint64_t before_span = 0;      ///< pictures of packets with kNoPicture, not delivered
    std::uint64_t damaged = 0;          ///< pictures with missing or concealed parts, not delivered
    std::uint64_t without_stamp = 0;    ///< pictures whose stamp is unknown, not delivered
    std::string codec_error;            ///< the codec cannot be opened at all
  };

  explicit VideoDecoder(Pixels pixels);
  ~VideoDecoder();
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  /// Pictures that became complete, in presentation order. The first packet may be anywhere; decoding starts
  /// at a keyframe. A decode_index that does not follow the last one is a gap: decoding goes on at the next
  /// keyframe.
  std::vector<ImagePtr> push(const VideoPacket& packet);
  /// The pictures still inside; afterwards the decoder can start anew.
  std::vector<ImagePtr> flush();
  [[nodiscard]] const Counts& counts() const;

 private:
  class Codec;
  std::unique_ptr<Codec> codec_;
};

}  // namespace atlas
