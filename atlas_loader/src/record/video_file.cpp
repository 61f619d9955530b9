// SPDX-License-Identifier: MIT
#include "record/video_file.hpp"

extern "C" {
#include <libavcodec/bsf.h>
#include <libavformat/avformat.h>
}

#include <deque>
#include <set>
#include <stdexcept>

#include "record/libav_support.hpp"

namespace atlas {
namespace {
constexpr std::size_t kMaxReordered = 64;  // packets; H.264 and H.265 reorder by at most 16

struct IndexEntry {
  std::int64_t position = 0, dts = 0, size = 0;
  bool keyframe = false;
};

std::size_t indexSize(const AVStream* stream) {
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(58, 76, 100)
  return static_cast<std::size_t>(avformat_index_get_entries_count(stream));
#else
  return static_cast<std::size_t>(stream->nb_index_entries);
#endif
}

IndexEntry indexEntry(AVStream* stream, std::size_t i) {
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(58, 76, 100)
  const AVIndexEntry* entry = avformat_index_get_entry(stream, static_cast<int>(i));
#else
  const AVIndexEntry* entry = &stream->index_entries[i];
#endif
  return {entry->pos, entry->timestamp, entry->size, (entry->flags & AVINDEX_KEYFRAME) != 0};
}
}  // namespace

class VideoFile::Demuxer {
 public:
  explicit Demuxer(const std::filesystem::path& path) : path_(path.string()) {
    silenceLibav();
    open();
    readIndex(path);
    if (frames + missing == 0) throw std::runtime_error(path_ + ": a video without pictures");
  }

  std::string codec;
  std::uint32_t width = 0, height = 0, frames = 0, missing = 0;

  std::optional<VideoPacket> next() {
    while (true) {
      if (!waiting_.empty() && waiting_.front().ranked) {
        VideoPacket packet = std::move(waiting_.front().packet);
        waiting_.pop_front();
        return packet;
      }
      if (ended_) return std::nullopt;
      readOne();
    }
  }

  void seek(std::uint32_t decode_index) {
    std::uint32_t keyframe = decode_index;
    while (keyframe > 0 && (keyframe >= entries_.size() || !entries_[keyframe].keyframe)) --keyframe;
    format_.reset();
    open();
    if (keyframe == 0 || startAt(keyframe)) return;
    format_.reset();  // from the beginning: slower, never wrong
    open();
  }

 private:
  struct Waiting {
    VideoPacket packet;
    std::int64_t pts;
    bool ranked;
  };

  void open() {
    AVFormatContext* context = nullptr;
    if (avformat_open_input(&context, path_.c_str(), nullptr, nullptr) < 0)
      throw std::runtime_error(path_ + ": not readable as a video");
    format_.reset(context);
    stream_ = -1;
    for (unsigned i = 0; i < context->nb_streams && stream_ < 0; ++i) {
      if (context->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO) stream_ = static_cast<int>(i);
    }
    if (stream_ < 0) throw std::runtime_error(path_ + ": no video stream");
    const AVCodecParameters* parameters = context->streams[stream_]->codecpar;
    codec = avcodec_get_name(parameters->codec_id);
    width = static_cast<std::uint32_t>(parameters->width);
    height = static_cast<std::uint32_t>(parameters->height);
    openFilter(parameters);
    waiting_.clear();
    pending_.clear();
    next_decode_ = next_rank_ = 0;
    ended_ = false;
  }

  /// mp4 stores NAL units with lengths; everybody else wants start codes (Annex B).
  void openFilter(const AVCodecParameters* parameters) {
    filter_.reset();
    extradata_.clear();
    const bool length_prefixed = parameters->extradata_size > 0 && parameters->extradata[0] == 1;
    const char* name = codec == "hevc" ? "hevc_mp4toannexb" : codec == "h264" ? "h264_mp4toannexb" : nullptr;
    if (name && length_prefixed) {
      AVBSFContext* filter = nullptr;
      const AVBitStreamFilter* type = av_bsf_get_by_name(name);
      if (!type || av_bsf_alloc(type, &filter) < 0)
        throw std::runtime_error(path_ + ": libav has no " + name);
      filter_.reset(filter);
      if (avcodec_parameters_copy(filter->par_in, parameters) < 0 || av_bsf_init(filter) < 0)
        throw std::runtime_error(path_ + ": codec parameters unreadable");
      parameters = filter->par_out;
    }
    if (parameters->extradata_size > 0)
      extradata_.assign(parameters->extradata, parameters->extradata + parameters->extradata_size);
  }

  void readIndex(const std::filesystem::path& path) {
    AVStream* stream = format_->streams[stream_];
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
    for (std::size_t i = 0; i < indexSize(stream); ++i) {
      const IndexEntry entry = indexEntry(stream, i);
      if (missing > 0 || entry.position + entry.size > bytes) {
        ++missing;
      } else {
        entries_.push_back(entry);
      }
    }
    frames = static_cast<std::uint32_t>(entries_.size());
    const bool partial_index = stream->nb_frames > static_cast<std::int64_t>(entries_.size() + missing);
    if (!entries_.empty() && !partial_index) return;
    entries_.clear();  // no index in the file (raw stream, fragments): count
    missing = 0;
    frames = 0;
    PacketPtr packet(av_packet_alloc());
    while (av_read_frame(format_.get(), packet.get()) >= 0) {
      frames += packet->stream_index == stream_ ? 1 : 0;
      av_packet_unref(packet.get());
    }
    format_.reset();
    open();
  }

  /// Continues at the keyframe or at one before it; false when that fails. Asks for the time of the last
  /// picture of the group: for the keyframe's own decoding time libav goes one group too far back, as it
  /// takes it for a time of presentation. Where it really is, the first packet's place in the file tells.
  bool startAt(std::uint32_t keyframe) {
    std::size_t last = keyframe;
    while (last + 1 < entries_.size() && !entries_[last + 1].keyframe) ++last;
    if (av_seek_frame(format_.get(), stream_, entries_[last].dts, AVSEEK_FLAG_BACKWARD) < 0) return false;
    PacketPtr packet(av_packet_alloc());
    do {
      av_packet_unref(packet.get());
      if (av_read_frame(format_.get(), packet.get()) < 0) return false;
    } while (packet->stream_index != stream_);
    std::uint32_t landed = 0;
    while (landed <= keyframe && entries_[landed].position != packet->pos) ++landed;
    if (landed > keyframe || !entries_[landed].keyframe) return false;
    next_decode_ = next_rank_ = landed;  // pictures before a keyframe in decoding order are shown before it
    take(packet);
    return true;
  }

  void readOne() {
    PacketPtr packet(av_packet_alloc());
    const bool cut = !entries_.empty() && next_decode_ >= frames;
    if (cut || av_read_frame(format_.get(), packet.get()) < 0) {
      ended_ = true;
      const bool whole = entries_.empty() || (missing == 0 && next_decode_ >= frames);
      whole ? rankUpTo(INT64_MAX) : giveUpRanks();
      return;
    }
    if (packet->stream_index == stream_) take(packet);
  }

  void take(PacketPtr& packet) {
    const std::int64_t order = static_cast<std::int64_t>(next_decode_);
    const std::int64_t dts = packet->dts != AV_NOPTS_VALUE ? packet->dts : order;
    const std::int64_t pts = packet->pts != AV_NOPTS_VALUE ? packet->pts : dts;
    Waiting entry{toVideoPacket(packet), pts, false};
    entry.packet.decode_index = next_decode_++;
    pending_.emplace(pts, entry.packet.decode_index);
    waiting_.push_back(std::move(entry));
    // Every later packet has dts > this dts and pts >= dts: pictures up to this dts are all known.
    rankUpTo(waiting_.size() > kMaxReordered ? INT64_MAX : dts);
  }

  void rankUpTo(std::int64_t pts) {
    while (!pending_.empty() && pending_.begin()->first <= pts) {
      const std::uint32_t decode_index = pending_.begin()->second;
      pending_.erase(pending_.begin());
      Waiting& entry = waiting_[decode_index - waiting_.front().packet.decode_index];
      entry.packet.pts_index = next_rank_++;
      entry.ranked = true;
    }
  }

  /// Pictures that are shown after ones that are not there: nobody knows how many come between.
  void giveUpRanks() {
    for (Waiting& entry : waiting_) {
      if (!entry.ranked) entry.packet.pts_index = kNoPicture;
      entry.ranked = true;
    }
    pending_.clear();
  }

  VideoPacket toVideoPacket(PacketPtr& packet) {
    VideoPacket out;
    out.codec = codec;
    out.keyframe = (packet->flags & AV_PKT_FLAG_KEY) != 0;
    if (out.keyframe) out.extradata = extradata_;
    if (filter_) {
      PacketPtr filtered(av_packet_alloc());
      PacketPtr input(av_packet_clone(packet.get()));
      if (av_bsf_send_packet(filter_.get(), input.get()) >= 0 &&
          av_bsf_receive_packet(filter_.get(), filtered.get()) >= 0) {
        out.data.assign(filtered->data, filtered->data + filtered->size);
        return out;
      }
      av_bsf_flush(filter_.get());  // a damaged packet goes on as it is; the decoder counts it
    }
    out.data.assign(packet->data, packet->data + packet->size);
    return out;
  }

  std::string path_;
  FormatPtr format_;
  FilterPtr filter_;
  int stream_ = -1;
  std::vector<std::uint8_t> extradata_;
  std::vector<IndexEntry> entries_;
  std::deque<Waiting> waiting_;                               ///< decode order
  std::set<std::pair<std::int64_t, std::uint32_t>> pending_;  ///< (pts, decode index) not yet ranked
  std::uint32_t next_decode_ = 0, next_rank_ = 0;
  bool ended_ = false;
};

VideoFile::VideoFile(const std::filesystem::path& path) : demuxer_(std::make_unique<Demuxer>(path)) {}
VideoFile::~VideoFile() = default;
const std::string& VideoFile::codec() const { return demuxer_->codec; }
std::uint32_t VideoFile::width() const { return demuxer_->width; }
std::uint32_t VideoFile::height() const { return demuxer_->height; }
std::uint32_t VideoFile::frames() const { return demuxer_->frames; }
std::uint32_t VideoFile::missingFrames() const { return demuxer_->missing; }
std::optional<VideoPacket> VideoFile::next() { return demuxer_->next(); }
void VideoFile::seek(std::uint32_t decode_index) { demuxer_->seek(decode_index); }

}  // namespace atlas
