// SPDX-License-Identifier: MIT
#include "record/video_source.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

namespace atlas::record {
namespace {
constexpr std::size_t kReorderImages = 16;  // pictures held to sort misordered rows; 7 MB each at 1920x1200
constexpr int kJpegQuality = 90;            // percent
}  // namespace

VideoSource::VideoSource(VideoOfCamera video, bool monotonic, std::shared_ptr<RecordLog> log)
    : video_(std::move(video)), log_(std::move(log)), monotonic_(monotonic) {
  log_->file(video_.name);
}

std::optional<Stamp> VideoSource::firstStamp() {
  const auto& rows = video_.table->rows();
  if (rows.empty()) return std::nullopt;
  return rows.front().stamp;
}

std::optional<Stamp> VideoSource::lastStamp() {
  const auto& rows = video_.table->rows();
  if (rows.empty()) return std::nullopt;
  return rows.back().stamp;
}

void VideoSource::limit(const TimeSpan& span) {
  span_ = span;
  video_.table->account(span);
  bool any = false;
  for (const FrameRow& row : video_.table->rows()) {
    if (!span.contains(row.stamp)) continue;
    if (!any || row.index < first_wanted_) {
      first_wanted_ = row.index;
      first_stamp_ = row.stamp;
    }
    end_wanted_ = std::max(end_wanted_, row.index + 1);
    any = true;
  }
  pictures_due_ = end_wanted_ - first_wanted_;
  if (any && first_wanted_ > 0) video_.file->seek(first_wanted_);
}

std::optional<VideoPacket> VideoSource::nextPacket() {
  if (pictures_due_ == 0 && next_index_ >= end_wanted_) return std::nullopt;
  auto packet = video_.file->next();
  if (!packet) return std::nullopt;
  next_index_ = packet->decode_index + 1;
  packet->frame = video_.camera;
  if (packet->pts_index == kNoPicture) ++unplaced_;
  const bool due = packet->pts_index >= first_wanted_ && packet->pts_index < end_wanted_;
  if (!due) packet->pts_index = kNoPicture;
  if (due) --pictures_due_;
  if (packet->decode_index < first_wanted_) {
    constexpr Duration kStep = 10;  // ns; more than the 1 ns of packets without a time of their own
    packet->stamp = first_stamp_ - kStep * static_cast<Duration>(first_wanted_ - packet->decode_index);
    return packet;
  }
  const bool inside = packet->decode_index < end_wanted_;
  const FrameRow* row = inside ? video_.table->find(packet->decode_index) : nullptr;
  packet->stamp = row ? row->stamp : stamp_before_ + 1;  // the first wanted one has a row
  if (monotonic_ && packet->decode_index > first_wanted_ && packet->stamp <= stamp_before_) {
    packet->stamp = stamp_before_ + 1;
    if (row) ++going_back_;
  }
  if (!row && inside) ++without_row_;
  stamp_before_ = packet->stamp;
  return packet;
}

void VideoSource::account(std::uint64_t used, const std::string& reason) {
  if (accounted_) return;
  accounted_ = true;
  const std::uint64_t frames = video_.file->frames();
  FileReport& report = log_->file(video_.name);
  report.rows = frames + video_.file->missingFrames();
  report.used = used;
  log_->skip(video_.name, "cut off: bytes missing", "", video_.file->missingFrames());
  std::uint64_t outside = 0, rowless = 0;
  for (std::uint64_t k = 0; k < frames; ++k) {
    const FrameRow* row = video_.table->find(k);
    if (row && !span_.contains(row->stamp)) ++outside;
    if (!row) ++rowless;
  }
  // Packets between a keyframe and its pictures may have been delivered without a row of their own.
  const std::uint64_t not_used = report.rows - video_.file->missingFrames() - std::min(used, frames);
  outside = std::min(outside, not_used);
  rowless = std::min(rowless, not_used - outside);
  log_->skip(video_.name, kOutsideSpan, "", outside);
  log_->skip(video_.name, "no row in timestamps.txt", "", rowless);
  log_->skip(video_.name, reason, "", not_used - outside - rowless);
}

PacketSource::PacketSource(VideoOfCamera video, std::shared_ptr<RecordLog> log)
    : VideoSource(std::move(video), true, std::move(log)) {}

std::optional<Event> PacketSource::next() {
  while (auto packet = nextPacket()) {
    started_ = started_ || packet->keyframe;
    if (!started_) continue;
    const bool inside = packet->decode_index >= first_wanted_ && packet->decode_index < end_wanted_;
    ++(inside ? used_ : outside_);
    const Stamp stamp = packet->stamp;
    return Event{stamp, video_.stream, std::make_shared<const VideoPacket>(std::move(*packet))};
  }
  if (outside_ > 0) {
    log_->note(video_.name + ": " + std::to_string(outside_) +
               " packets around the span kept, some of its pictures cannot be decoded without them");
  }
  if (unplaced_ > 0) {
    log_->note(video_.name + ": cut, " + std::to_string(unplaced_) +
               " pictures at its end whose place in time is unknown, they have no stamp");
  }
  if (without_row_ > 0) {
    log_->note(video_.name + ": " + std::to_string(without_row_) +
               " packets without a row in timestamps.txt, their pictures have no stamp");
  }
  if (going_back_ > 0) {
    log_->note(video_.name + ": " + std::to_string(going_back_) +
               " packets whose row goes back in time: their pictures have no stamp (decoding while reading "
               "sorts them)");
  }
  account(used_, "unreadable");
  return std::nullopt;
}

ImageSource::ImageSource(VideoOfCamera video, VideoDecoder::Pixels pixels, bool encode,
                         std::shared_ptr<RecordLog> log)
    : VideoSource(std::move(video), false, std::move(log)), decoder_(pixels), encode_(encode) {}

void ImageSource::take(std::vector<ImagePtr> images) {
  for (ImagePtr& image : images) {
    if (!span_.contains(image->stamp)) continue;
    if (image->stamp < delivered_) {
      ++too_late_;
      continue;
    }
    const auto key = std::make_pair(image->stamp, taken_++);
    window_.emplace(key, std::move(image));
  }
}

ImagePtr ImageSource::encoded(const ImagePtr& image) const {
  auto jpeg = std::make_shared<Image>();
  jpeg->stamp = image->stamp;
  jpeg->frame = image->frame;
  jpeg->format = "jpeg";
  cv::imencode(".jpg", image->pixels, jpeg->encoded, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return jpeg;
}

std::optional<Event> ImageSource::next() {
  const std::size_t hold = std::min(video_.table->disorder(), kReorderImages);
  while (!flushed_ && window_.size() <= hold) {
    const auto packet = nextPacket();
    if (packet) {
      take(decoder_.push(*packet));
    } else {
      take(decoder_.flush());
      flushed_ = true;
    }
  }
  if (window_.empty()) {
    end();
    return std::nullopt;
  }
  const auto first = window_.extract(window_.begin());
  delivered_ = first.key().first;
  ++used_;
  return Event{delivered_, video_.stream, encode_ ? encoded(first.mapped()) : first.mapped()};
}

void ImageSource::end() {
  const VideoDecoder::Counts& counts = decoder_.counts();
  if (!counts.codec_error.empty()) log_->note(video_.name + ": " + counts.codec_error);
  if (counts.undecodable + counts.damaged + counts.without_stamp + too_late_ > 0) {
    log_->note(video_.name + ": " + std::to_string(counts.undecodable) + " packets not decodable, " +
               std::to_string(counts.damaged) + " pictures damaged, " + std::to_string(counts.without_stamp) +
               " without a stamp, " + std::to_string(too_late_) + " too far out of order");
  }
  account(used_, unplaced_ > 0 ? "not decodable, or of unknown place in a cut video" : "not decodable");
}

}  // namespace atlas::record
