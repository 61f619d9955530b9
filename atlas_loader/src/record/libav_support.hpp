// SPDX-License-Identifier: MIT
// Owners for objects of libav, and its silence.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavcodec/bsf.h>
#include <libavformat/avformat.h>
#include <libavutil/frame.h>
#include <libavutil/log.h>
#include <libswscale/swscale.h>
}

#include <memory>

namespace atlas {

struct LibavFree {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVBSFContext* p) const { av_bsf_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
using FormatPtr = std::unique_ptr<AVFormatContext, LibavFree>;
using CodecPtr = std::unique_ptr<AVCodecContext, LibavFree>;
using FilterPtr = std::unique_ptr<AVBSFContext, LibavFree>;
using PacketPtr = std::unique_ptr<AVPacket, LibavFree>;
using FramePtr = std::unique_ptr<AVFrame, LibavFree>;
using ScalerPtr = std::unique_ptr<SwsContext, LibavFree>;

/// libav prints complaints about damaged streams to stderr; ours are counted instead.
inline void silenceLibav() { av_log_set_level(AV_LOG_QUIET); }

}  // namespace atlas
