// SPDX-License-Identifier: MIT
#include "video_decode_stage.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "record/video_file.hpp"

namespace atlas_loader {
namespace {

std::vector<std::string> inputNames(const std::vector<std::string>& cameras) {
  std::vector<std::string> names;
  for (const std::string& camera : cameras) {
    for (const char* kind : {"/packets", "/image_raw/compressed", "/image_raw"})
      names.push_back(camera + kind);
  }
  if (names.empty())
    names.emplace_back("none");  // a decoder with nothing to do ends with its one silent input
  return names;
}

/// libav leaves no picture behind for ever: more than this many packets without their picture are lost ones.
constexpr std::size_t kMostOwed = 64;

}  // namespace

VideoDecodeStage::VideoDecodeStage(const VideoDecodeParams& params)
    : Stage("video_decoder", inputNames(params.cameras)), params_(params), cameras_(params.cameras.size()) {}

atlas::VideoDecoder::Pixels VideoDecodeStage::pixelsOf(std::size_t camera) const {
  const auto& mono = params_.mono_cameras;
  const bool is_mono = std::find(mono.begin(), mono.end(), params_.cameras[camera]) != mono.end();
  return is_mono ? atlas::VideoDecoder::Pixels::kMono8 : atlas::VideoDecoder::Pixels::kBgr8;
}

void VideoDecodeStage::push(std::size_t camera, const atlas::VideoPacketPtr& packet) {
  enqueue(kKinds * camera + kPackets, packet->stamp, [this, camera, packet] {
    Camera& c = cameras_[camera];
    if (!c.decoder) c.decoder = std::make_unique<atlas::VideoDecoder>(pixelsOf(camera));
    counters_.add("packets");
    c.owed[packet->stamp] = packet->pts_index != atlas::kNoPicture;
    emit(camera, c.decoder->push(*packet));
    while (c.owed.size() > kMostOwed) {
      if (c.owed.begin()->second) counters_.skip("picture", atlas::Reason::kEmpty);
      c.owed.erase(c.owed.begin());
    }
  });
}

void VideoDecodeStage::pushCompressed(std::size_t camera, const atlas::ImagePtr& image) {
  enqueue(kKinds * camera + kCompressed, image->stamp, [this, camera, image] {
    auto decoded = std::make_shared<atlas::Image>();
    decoded->stamp = image->stamp;
    decoded->frame = image->frame;
    if (!image->encoded.empty()) decoded->pixels = cv::imdecode(image->encoded, cv::IMREAD_COLOR);
    decoded->format = "bgr8";
    if (decoded->pixels.empty()) {
      counters_.skip("image", atlas::Reason::kBadLayout);
      return;
    }
    emit(camera, {decoded});
  });
}

void VideoDecodeStage::pushRaw(std::size_t camera, const atlas::ImagePtr& image) {
  enqueue(kKinds * camera + kRaw, image->stamp, [this, camera, image] { emit(camera, {image}); });
}

void VideoDecodeStage::emit(std::size_t camera, const std::vector<atlas::ImagePtr>& images) {
  for (const atlas::ImagePtr& image : images) {
    auto& owed = cameras_[camera].owed;
    // Pictures come out in order of presentation: whatever is still owed before this one will never come.
    owed.erase(owed.begin(), owed.upper_bound(image->stamp));
    counters_.add("images");
    if (on_image) on_image(camera, image);
  }
}

atlas::Stamp VideoDecodeStage::heldBackFrom() const {
  atlas::Stamp first = atlas::kEndOfTime;
  for (const Camera& camera : cameras_) {
    if (!camera.owed.empty()) first = std::min(first, camera.owed.begin()->first);
  }
  return first;
}

void VideoDecodeStage::onEnd() {
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    cameras_[c].owed.clear();
    if (!cameras_[c].decoder) continue;
    emit(c, cameras_[c].decoder->flush());
    const atlas::VideoDecoder::Counts& counts = cameras_[c].decoder->counts();
    const std::string what = "skipped " + params_.cameras[c];
    const auto add = [&](const char* reason, std::uint64_t n) {
      if (n > 0) counters_.add(what + reason, n);
    };
    add(" packet: before the first keyframe", counts.before_keyframe);
    add(" packet: undecodable", counts.undecodable);
    add(" picture: damaged", counts.damaged);
    add(" picture: without stamp", counts.without_stamp);
  }
}

}  // namespace atlas_loader
