// SPDX-License-Identifier: MIT
// Stage: video packets, JPEG or PNG bytes, or pixels of a camera become decoded images `<camera>/image`,
// whichever of them the record has. (The output is not called image_raw: a bag may already carry a topic of
// that name, and a topic has one producer.)
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "atlas/base/local_graph.hpp"
#include "atlas/sensor/sensor.hpp"
#include "record/video_decoder.hpp"

namespace atlas_loader {

struct VideoDecodeParams {
  std::vector<std::string> cameras;
  std::vector<std::string> mono_cameras;  ///< of these, grey pictures (thermal cameras)
};
template <class Reader>
void readParams(Reader& reader, VideoDecodeParams& params) {
  reader.read("cameras", params.cameras);
  reader.read("mono_cameras", params.mono_cameras);
}

class VideoDecodeStage : public atlas::Stage {
 public:
  /// Inputs of camera c: 3 c packets, 3 c + 1 compressed images, 3 c + 2 raw images.
  enum Kind : std::size_t { kPackets, kCompressed, kRaw, kKinds };
  explicit VideoDecodeStage(const VideoDecodeParams& params);

  void push(std::size_t camera, const atlas::VideoPacketPtr& packet);
  void pushCompressed(std::size_t camera, const atlas::ImagePtr& image);
  void pushRaw(std::size_t camera, const atlas::ImagePtr& image);

  std::function<void(std::size_t camera, const atlas::ImagePtr&)> on_image;

 private:
  struct Camera {
    std::unique_ptr<atlas::VideoDecoder> decoder;
    std::map<atlas::Stamp, bool>
        owed;  ///< stamps of packets whose picture has not come out yet; true = has one
  };
  [[nodiscard]] atlas::Stamp heldBackFrom() const override;
  void onEnd() override;
  [[nodiscard]] atlas::VideoDecoder::Pixels pixelsOf(std::size_t camera) const;
  void emit(std::size_t camera, const std::vector<atlas::ImagePtr>& images);

  VideoDecodeParams params_;
  std::vector<Camera> cameras_;
};

template <class Bus>
atlas::StageFactory bindVideoDecoder(Bus& bus, const VideoDecodeParams& params) {
  using S = VideoDecodeStage;
  std::vector<std::function<void(const atlas::ImagePtr&)>> images;
  for (std::size_t c = 0; c < params.cameras.size(); ++c) {
    const std::string& camera = params.cameras[c];
    bus.template input<S, atlas::VideoPacketPtr>(
        S::kKinds * c + S::kPackets, camera + "/packets",
        [c](S& s, const atlas::VideoPacketPtr& packet) { s.push(c, packet); });
    bus.template input<S, atlas::EncodedImage>(
        S::kKinds * c + S::kCompressed, camera + "/image_raw/compressed",
        [c](S& s, const atlas::EncodedImage& encoded) { s.pushCompressed(c, encoded.image); });
    bus.template input<S, atlas::ImagePtr>(S::kKinds * c + S::kRaw, camera + "/image_raw",
                                           [c](S& s, const atlas::ImagePtr& image) { s.pushRaw(c, image); });
    images.push_back(bus.template output<atlas::ImagePtr>(camera + "/image"));
  }
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_image = [images](std::size_t camera, const atlas::ImagePtr& image) {
      images.at(camera)(image);
    };
    return stage;
  };
}

}  // namespace atlas_loader
