// SPDX-License-Identifier: MIT
#include "synthetic/video_encoder.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include <stdexcept>
#include <string>

namespace atlas::synthetic {
namespace {

void check(int result, const char* what) {
  if (result >= 0) return;
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(result, text, sizeof text);
  throw std::runtime_error(std::string("video: ") + what + ": " + text);
}

}  // namespace

struct VideoEncoder::Codec {
  AVFormatContext* format = nullptr;
  AVCodecContext* context = nullptr;
  AVStream* stream = nullptr;
  AVFrame* frame = nullptr;
  AVPacket* packet = nullptr;
  std::int64_t next_pts = 0;
  bool open = false;
  ~Codec() {
    av_packet_free(&packet);
    av_frame_free(&frame);
    avcodec_free_context(&context);
    if (format != nullptr && format->pb != nullptr) avio_closep(&format->pb);
    avformat_free_context(format);
  }
};

VideoEncoder::VideoEncoder(const std::filesystem::path& file, int width, int height, int frames_per_second)
    : codec_(std::make_unique<Codec>()) {
  Codec& c = *codec_;
  const AVCodec* encoder = avcodec_find_encoder_by_name("libx265");
  if (encoder == nullptr) throw std::runtime_error("video: libavcodec has no encoder libx265");
  check(avformat_alloc_output_context2(&c.format, nullptr, "mp4", file.c_str()), "mp4");
  c.format->flags |= AVFMT_FLAG_BITEXACT;
  c.context = avcodec_alloc_context3(encoder);
  c.context->width = width;
  c.context->height = height;
  c.context->pix_fmt = AV_PIX_FMT_YUV420P;
  c.context->color_range = AVCOL_RANGE_MPEG;
  c.context->colorspace = AVCOL_SPC_SMPTE170M;
  c.context->time_base = {1, frames_per_second};
  c.context->framerate = {frames_per_second, 1};
  c.context->thread_count = 1;
  c.context->flags |= AV_CODEC_FLAG_BITEXACT;
  if ((c.format->oformat->flags & AVFMT_GLOBALHEADER) != 0) c.context->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  check(av_opt_set(c.context->priv_data, "preset", "ultrafast", 0), "preset");
  check(av_opt_set(c.context->priv_data, "crf", "24", 0), "crf");
  // One thread and no pool: the order of work, and with it every bit, is fixed.
  check(av_opt_set(c.context->priv_data, "x265-params",
                   "pools=none:frame-threads=1:wpp=0:log-level=error:info=0:open-gop=0:keyint=30", 0),
        "x265-params");
  check(avcodec_open2(c.context, encoder, nullptr), "open libx265");
  c.stream = avformat_new_stream(c.format, nullptr);
  check(avcodec_parameters_from_context(c.stream->codecpar, c.context), "parameters");
  c.stream->time_base = c.context->time_base;
  check(avio_open(&c.format->pb, file.c_str(), AVIO_FLAG_WRITE), file.c_str());
  check(avformat_write_header(c.format, nullptr), "header");
  c.open = true;
  c.frame = av_frame_alloc();
  c.frame->format = AV_PIX_FMT_YUV420P;
  c.frame->width = width;
  c.frame->height = height;
  c.frame->color_range = AVCOL_RANGE_MPEG;
  c.frame->colorspace = AVCOL_SPC_SMPTE170M;
  check(av_frame_get_buffer(c.frame, 0), "frame");
  c.packet = av_packet_alloc();
}

VideoEncoder::~VideoEncoder() = default;

// ITU-R BT.601, limited range, in 1/256.
void VideoEncoder::addRgb(const std::vector<std::uint8_t>& rgb) {
  check(av_frame_make_writable(codec_->frame), "frame");
  AVFrame& frame = *codec_->frame;
  for (int v = 0; v < frame.height; v += 2) {
    for (int u = 0; u < frame.width; u += 2) {
      int red = 0, green = 0, blue = 0;
      for (int k = 0; k < 4; ++k) {
        const int y = v + k / 2, x = u + k % 2;
        const std::uint8_t* p = &rgb[3 * static_cast<std::size_t>(y * frame.width + x)];
        frame.data[0][y * frame.linesize[0] + x] =
            static_cast<std::uint8_t>(((66 * p[0] + 129 * p[1] + 25 * p[2] + 128) >> 8) + 16);
        red += p[0];
        green += p[1];
        blue += p[2];
      }
      const int at_u = v / 2 * frame.linesize[1] + u / 2, at_v = v / 2 * frame.linesize[2] + u / 2;
      frame.data[1][at_u] =
          static_cast<std::uint8_t>((-38 * red - 74 * green + 112 * blue + 4 * 128 + 4 * 128 * 256) >> 10);
      frame.data[2][at_v] =
          static_cast<std::uint8_t>((112 * red - 94 * green - 18 * blue + 4 * 128 + 4 * 128 * 256) >> 10);
    }
  }
  encode(false);
}

void VideoEncoder::addGrey(const std::vector<std::uint8_t>& grey) {
  check(av_frame_make_writable(codec_->frame), "frame");
  AVFrame& frame = *codec_->frame;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const int g = grey[static_cast<std::size_t>(v * frame.width + u)];
      frame.data[0][v * frame.linesize[0] + u] = static_cast<std::uint8_t>(16 + (g * 219 + 127) / 255);
      if (v % 2 == 0 && u % 2 == 0) {
        frame.data[1][v / 2 * frame.linesize[1] + u / 2] = 128;
        frame.data[2][v / 2 * frame.linesize[2] + u / 2] = 128;
      }
    }
  }
  encode(false);
}

void VideoEncoder::encode(bool flush) {
  Codec& c = *codec_;
  if (!flush) c.frame->pts = c.next_pts++;
  check(avcodec_send_frame(c.context, flush ? nullptr : c.frame), "encode");
  for (;;) {
    const int result = avcodec_receive_packet(c.context, c.packet);
    if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
    check(result, "encode");
    if (c.packet->duration == 0) c.packet->duration = 1;
    av_packet_rescale_ts(c.packet, c.context->time_base, c.stream->time_base);
    c.packet->stream_index = c.stream->index;
    check(av_interleaved_write_frame(c.format, c.packet), "write");
  }
}

void VideoEncoder::close() {
  if (!codec_->open) return;
  codec_->open = false;
  encode(true);
  check(av_write_trailer(codec_->format), "trailer");
}

}  // namespace atlas::synthetic
