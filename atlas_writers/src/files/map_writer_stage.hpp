// SPDX-License-Identifier: MIT
// The map writer as a stage; with colour it looks at pictures and depth images, too.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "files/map_colours.hpp"
#include "files/map_writer.hpp"

namespace atlas {

struct MapWriterParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  std::vector<std::string> colour_cameras;  ///< they need depth images; looked at only with map.colour
  MapParams map;
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const MapWriterParams& params);

class MapWriterStage : public Stage {
 public:
  /// Inputs: 0 anchor, 1 + i batches of params.lidars[i]; with colour then those of colourInput().
  enum Input : std::size_t { kAnchor, kFirstLidar };
  enum ColourInput : std::size_t { kTfStatic, kOdometry, kInfo, kPicture, kDepth, kConfidence, kEnd };
  /// Those from kInfo on are there once a camera.
  static std::size_t colourInput(const MapWriterParams& params, ColourInput input, std::size_t camera = 0) {
    return kFirstLidar + params.lidars.size() + input + camera * (kEnd - kInfo);
  }

  MapWriterStage(const MapWriterParams& params, const std::filesystem::path& out);
  ~MapWriterStage() override;
  void push(const Anchor& anchor);
  void push(std::size_t lidar, const BatchedSweepPtr& batched);
  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const Odometry& odometry);
  void push(std::size_t camera, const CameraInfo& info);
  void push(std::size_t camera, const ImagePtr& picture);
  void pushDepth(std::size_t camera, const DepthImagePtr& depth);
  void pushConfidence(std::size_t camera, const DepthImagePtr& confidence);

 private:
  void onProgress() override { colour(merge().watermark()); }
  void onEnd() override;
  void colour(Stamp merged);
  void finishOnce();

  MapWriterParams params_;
  MapWriter writer_;
  MapColours colours_;
  std::optional<Anchor> anchor_;
  bool finished_ = false;
};

}  // namespace atlas
