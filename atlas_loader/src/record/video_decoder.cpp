// SPDX-License-Identifier: MIT
#include "record/video_decoder.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <opencv2/imgproc.hpp>

#include "record/libav_support.hpp"
#include "record/video_file.hpp"

namespace atlas {
namespace {

/// Luma of a YUV picture as grey values 0..255: limited range (16..235, ITU-R BT.601) is stretched.
std::array<std::uint8_t, 256> greyOfLuma(bool full_range) {
  std::array<std::uint8_t, 256> grey{};
  for (int y = 0; y < 256; ++y) {
    const int stretched = (std::max(y - 16, 0) * 255 + 109) / 219;
    grey[static_cast<std::size_t>(y)] = static_cast<std::uint8_t>(full_range ? y : std::min(stretched, 255));
  }
  return grey;
}

bool has8BitLumaPlane(const AVPixFmtDescriptor* format) {
  const bool rgb = (format->flags & AV_PIX_FMT_FLAG_RGB) != 0;
  return !rgb && format->comp[0].plane == 0 && format->comp[0].depth == 8 && format->comp[0].step == 1;
}

bool isFullRange(const AVFrame& frame) {
  const auto format = static_cast<AVPixelFormat>(frame.format);
  return frame.color_range == AVCOL_RANGE_JPEG || format == AV_PIX_FMT_YUVJ420P ||
         format == AV_PIX_FMT_YUVJ422P || format == AV_PIX_FMT_YUVJ444P || format == AV_PIX_FMT_GRAY8;
}
/// The usual layout of video, for which OpenCV has a conversion six times as fast as that of libswscale:
/// 4:2:0, limited range, not BT.709 (unspecified = BT.601, as in libswscale), even sides.
bool isPlain420(const AVFrame& frame) {
  return frame.format == AV_PIX_FMT_YUV420P && frame.color_range != AVCOL_RANGE_JPEG &&
         frame.colorspace != AVCOL_SPC_BT709 && frame.width % 2 == 0 && frame.height % 2 == 0;
}

cv::Mat bgrOfPlain420(const AVFrame& frame) {
  cv::Mat planes(frame.height * 3 / 2, frame.width, CV_8UC1);  // Y, then U, then V
  std::uint8_t* to = planes.data;
  for (int plane = 0; plane < 3; ++plane) {
    const int width = plane == 0 ? frame.width : frame.width / 2;
    const int height = plane == 0 ? frame.height : frame.height / 2;
    for (int row = 0; row < height; ++row, to += width) {
      std::memcpy(to, frame.data[plane] + static_cast<std::ptrdiff_t>(row) * frame.linesize[plane],
                  static_cast<std::size_t>(width));
    }
  }
  cv::Mat image;
  cv::cvtColor(planes, image, cv::COLOR_YUV2BGR_I420);
  return image;
}
}  // namespace

class VideoDecoder::Codec {
 public:
  explicit Codec(Pixels pixels) : pixels_(pixels) { silenceLibav(); }

  Counts counts;

  std::vector<ImagePtr> push(const VideoPacket& packet) {
    ++counts.packets;
    std::vector<ImagePtr> images;
    if (context_ && packet.decode_index != last_decode_index_ + 1) {
      images = flush();
    }
    rememberStamp(packet);
    if (!context_ && !packet.keyframe) {
      ++counts.before_keyframe;
      return images;
    }
    if (!context_ && !open(packet)) return images;
    PacketPtr data(av_packet_alloc());
    if (packet.data.empty() || av_new_packet(data.get(), static_cast<int>(packet.data.size())) < 0) {
      ++counts.undecodable;
      return images;
    }
    std::memcpy(data->data, packet.data.data(), packet.data.size());
    data->pts = packet.pts_index;
    data->dts = packet.decode_index;
    if (packet.keyframe) data->flags |= AV_PKT_FLAG_KEY;
    if (avcodec_send_packet(context_.get(), data.get()) < 0) ++counts.undecodable;
    receive(images);
    return images;
  }

  std::vector<ImagePtr> flush() {
    std::vector<ImagePtr> images;
    if (!context_) return images;
    avcodec_send_packet(context_.get(), nullptr);
    receive(images);
    context_.reset();
    return images;
  }

 private:
  bool open(const VideoPacket& packet) {
    const AVCodec* type = avcodec_find_decoder_by_name(packet.codec.c_str());
    if (!type) {
      const AVCodecDescriptor* descriptor = avcodec_descriptor_get_by_name(packet.codec.c_str());
      type = descriptor ? avcodec_find_decoder(descriptor->id) : nullptr;
    }
    context_.reset(type ? avcodec_alloc_context3(type) : nullptr);
    if (!context_) {
      counts.codec_error = "no decoder for '" + packet.codec + "'";
      ++counts.undecodable;
      return false;
    }
    context_->thread_count = 1;
    context_->pkt_timebase = AVRational{1, 10};
    if (!packet.extradata.empty()) {
      const std::size_t size = packet.extradata.size();
      context_->extradata = static_cast<std::uint8_t*>(av_mallocz(size + AV_INPUT_BUFFER_PADDING_SIZE));
      if (context_->extradata) {
        std::memcpy(context_->extradata, packet.extradata.data(), size);
        context_->extradata_size = static_cast<int>(size);
      }
    }
    if (avcodec_open2(context_.get(), type, nullptr) < 0) {
      counts.codec_error = "decoder of '" + packet.codec + "' refuses the stream";
      ++counts.undecodable;
      context_.reset();
      return false;
    }
    return true;
  }

  void rememberStamp(const VideoPacket& packet) {
    const bool own_time = stamps_.empty() || packet.stamp > last_stamp_ + 1 || packet.stamp < last_stamp_;
    if (own_time) stamps_[packet.decode_index] = packet.stamp;
    if (!own_time) stamps_.erase(packet.decode_index);
    last_stamp_ = packet.stamp;
    last_decode_index_ = packet.decode_index;
    frame_ = packet.frame;
    constexpr std::size_t kKept = 256;  // far more than the 16 pictures that a codec reorders
    while (stamps_.size() > kKept) stamps_.erase(stamps_.begin());
  }

  void receive(std::vector<ImagePtr>& images) {
    FramePtr frame(av_frame_alloc());
    while (avcodec_receive_frame(context_.get(), frame.get()) >= 0) {
      const bool damaged = (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame->decode_error_flags != 0;
      const auto stamp = stamps_.find(static_cast<std::uint32_t>(frame->pts));
      if (frame->pts == kNoPicture) {
        ++counts.before_span;
      } else if (damaged) {
        ++counts.damaged;
      } else if (frame->pts < 0 || stamp == stamps_.end()) {
        ++counts.without_stamp;
      } else {
        auto image = std::make_shared<Image>();
        image->stamp = stamp->second;
        image->frame = frame_;
        image->format = pixels_ == Pixels::kMono8 ? "mono8" : "bgr8";
        image->pixels = pixels_ == Pixels::kMono8 ? mono(*frame) : bgr(*frame);
        ++(image->pixels.empty() ? counts.damaged : counts.images);
        if (!image->pixels.empty()) images.push_back(std::move(image));
      }
      av_frame_unref(frame.get());
    }
  }

  cv::Mat bgr(const AVFrame& frame) {
    if (isPlain420(frame)) return bgrOfPlain420(frame);
    const auto format = static_cast<AVPixelFormat>(frame.format);
    constexpr int kFlags = SWS_BILINEAR | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INT;
    scaler_.reset(sws_getCachedContext(scaler_.release(), frame.width, frame.height, format, frame.width,
                                       frame.height, AV_PIX_FMT_BGR24, kFlags, nullptr, nullptr, nullptr));
    if (!scaler_) return {};
    const int matrix = frame.colorspace == AVCOL_SPC_BT709 ? SWS_CS_ITU709 : SWS_CS_DEFAULT;
    const int* coefficients = sws_getCoefficients(matrix);
    constexpr int kOne = 1 << 16;  // contrast and saturation 1
    sws_setColorspaceDetails(scaler_.get(), coefficients, isFullRange(frame) ? 1 : 0, coefficients, 1, 0,
                             kOne, kOne);
    cv::Mat image(frame.height, frame.width, CV_8UC3);
    std::uint8_t* planes[4] = {image.data, nullptr, nullptr, nullptr};
    const int strides[4] = {static_cast<int>(image.step[0]), 0, 0, 0};
    sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, planes, strides);
    return image;
  }

  cv::Mat mono(const AVFrame& frame) {
    const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
    cv::Mat image;
    if (!format || !has8BitLumaPlane(format)) {
      const cv::Mat colour = bgr(frame);
      if (!colour.empty()) cv::cvtColor(colour, image, cv::COLOR_BGR2GRAY);
      return image;
    }
    const auto grey = greyOfLuma(isFullRange(frame));
    image.create(frame.height, frame.width, CV_8UC1);
    for (int row = 0; row < frame.height; ++row) {
      const std::uint8_t* from = frame.data[0] + static_cast<std::ptrdiff_t>(row) * frame.linesize[0];
      std::transform(from, from + frame.width, image.ptr(row), [&grey](std::uint8_t y) { return grey[y]; });
    }
    return image;
  }

  Pixels pixels_;
  CodecPtr context_;
  ScalerPtr scaler_;
  std::map<std::uint32_t, Stamp> stamps_;  ///< by decode_index
  Stamp last_stamp_ = 0;
  std::uint32_t last_decode_index_ = 0;
  std::string frame_;
};

VideoDecoder::VideoDecoder(Pixels pixels) : codec_(std::make_unique<Codec>(pixels)) {}
VideoDecoder::~VideoDecoder() = default;
std::vector<ImagePtr> VideoDecoder::push(const VideoPacket& packet) { return codec_->push(packet); }
std::vector<ImagePtr> VideoDecoder::flush() { return codec_->flush(); }
const VideoDecoder::Counts& VideoDecoder::counts() const { return codec_->counts; }

}  // namespace atlas
