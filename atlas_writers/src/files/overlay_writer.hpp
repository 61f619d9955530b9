// SPDX-License-Identifier: MIT
// Pictures for people, now and then: a camera image with the lidar points coloured by depth and the frustums'
// boxes. overlay/<camera>/<image index, 6 digits>.png
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct OverlayWriterParams {
  std::vector<std::string> cameras = {"camera_left_front"};
  double period_s = 2.0;  ///< event time between pictures of a camera
};
void validate(const OverlayWriterParams& params);

/// Inputs per camera c (3 c + k): 0 image, 1 depth, 2 frustums. They are joined by their equal stamps.
class OverlayWriterStage : public Stage {
 public:
  OverlayWriterStage(const OverlayWriterParams& params, std::filesystem::path out);
  enum Part : std::size_t { kImage, kDepth, kFrustums, kParts };
  static std::size_t input(std::size_t camera, Part part) { return camera * kParts + part; }

  void push(std::size_t camera, const ImagePtr& image);
  void push(std::size_t camera, const DepthImagePtr& depth);
  void push(std::size_t camera, const Frustums& frustums);

  std::function<void(std::size_t camera, const ImagePtr&)> on_overlay;  ///< bgr8, the picture of the file

 protected:
  void onProgress() override;
  void onEnd() override { onProgress(); }

 private:
  struct Picture {
    std::uint32_t index = 0;
    ImagePtr image;
    DepthImagePtr depth;
    std::optional<Frustums> frustums;
  };
  void write(std::size_t camera, const Picture& picture);

  OverlayWriterParams params_;
  std::filesystem::path out_;
  std::vector<std::uint32_t> image_count_;
  std::vector<std::int64_t> last_period_;          ///< per camera: stamp / period of its last picture
  std::vector<std::map<Stamp, Picture>> waiting_;  ///< per camera
};

}  // namespace atlas
