// SPDX-License-Identifier: MIT
// The video of a camera as events: packets as recorded, or pictures decoded on the way. Time comes from the
// frame table.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>

#include "record/frame_table.hpp"
#include "record/open_record.hpp"
#include "record/video_decoder.hpp"
#include "record/video_file.hpp"

namespace atlas::record {

struct VideoOfCamera {
  std::unique_ptr<VideoFile> file;
  std::shared_ptr<FrameTable> table;
  std::string name;    ///< in reports: "camera_ir/video.mp4"
  std::string camera;  ///< frame id
  std::size_t stream = 0;
};

/// What both sources share: which packets are wanted and what became of each picture.
class VideoSource : public EventSource {
 public:
  /// monotonic: stamps of packets never go back (see VideoDecoder: such a packet gives up its time).
  VideoSource(VideoOfCamera video, bool monotonic, std::shared_ptr<RecordLog> log);
  std::optional<Stamp> firstStamp() override;
  std::optional<Stamp> lastStamp() override;
  void limit(const TimeSpan& span) override;

 protected:
  /// The next packet with stamp and frame; nullopt at the end of the span or of the file. A packet without a
  /// row comes 1 ns after the one before it (see VideoDecoder). Packets from outside of the span that its
  /// pictures need come too, with kNoPicture: those from the keyframe on 10 ns apart before the first stamp,
  /// those behind (pictures are not stored in order) 1 ns apart after the last.
  std::optional<VideoPacket> nextPacket();
  /// Books all pictures: `used` were delivered, `unread` could not be, for `reason`, the others have their
  /// own reasons.
  void account(std::uint64_t used, const std::string& reason);

  VideoOfCamera video_;
  std::shared_ptr<RecordLog> log_;
  TimeSpan span_;
  std::uint32_t first_wanted_ = 0, end_wanted_ = 0;  ///< decode indices [first, end)
  std::uint64_t without_row_ = 0, going_back_ = 0;
  std::uint64_t unplaced_ = 0;  ///< pictures at the end of a cut file

 private:
  bool monotonic_;
  Stamp first_stamp_ = 0;  ///< of the first wanted packet
  Stamp stamp_before_ = 0;
  std::uint32_t next_index_ = 0, pictures_due_ = 0;
  bool accounted_ = false;
};

/// Packets in decoding order, from the keyframe that the first picture of the span needs.
class PacketSource : public VideoSource {
 public:
  PacketSource(VideoOfCamera video, std::shared_ptr<RecordLog> log);
  std::optional<Event> next() override;

 private:
  bool started_ = false;
  std::uint64_t used_ = 0, outside_ = 0;
};

/// Pictures in order of stamps, as pixels or as JPEG.
class ImageSource : public VideoSource {
 public:
  ImageSource(VideoOfCamera video, VideoDecoder::Pixels pixels, bool encode, std::shared_ptr<RecordLog> log);
  std::optional<Event> next() override;

 private:
  void take(std::vector<ImagePtr> images);
  [[nodiscard]] ImagePtr encoded(const ImagePtr& image) const;
  void end();

  VideoDecoder decoder_;
  bool encode_;
  std::map<std::pair<Stamp, std::uint64_t>, ImagePtr> window_;
  std::uint64_t taken_ = 0, used_ = 0, too_late_ = 0;
  Stamp delivered_ = kBeginOfTime;
  bool flushed_ = false;
};

}  // namespace atlas::record
