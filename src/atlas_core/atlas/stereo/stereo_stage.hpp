// SPDX-License-Identifier: MIT
// Stage: images of two cameras side by side become disparities, the occupancy in the plane of column and
// disparity, and the ground before the cameras from above, which the occupancy filter takes in.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/sensor/sensor_grid.hpp"
#include "atlas/stereo/rectifier.hpp"
#include "atlas/stereo/stereo_ground.hpp"
#include "atlas/stereo/stereo_matcher.hpp"
#include "atlas/stereo/u_disparity.hpp"

namespace atlas {

struct StereoStageParams {
  std::string name = "stereo";  ///< of the pair: its topics are stereo/disparity, ...
  std::string left_camera = "camera_left_front", right_camera = "camera_right_front";
  double max_stamp_difference_s = 0.005;  ///< of the two images of a pair
  int width_px = 640;                     ///< images are made so small before they are matched; 0: as taken
  StereoParams matcher;
  UDisparityParams u_disparity;
  /// The ground seen from above: ahead of the left camera, and to both sides.
  double ground_ahead_m = 40.0, ground_width_m = 40.0, ground_cell_m = 0.2;
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const StereoStageParams& params);

/// Disparities of one pair.
struct StereoDisparity {
  Stamp stamp = 0;    ///< of the left image
  std::string frame;  ///< optical frame of the left camera
  StereoRig rig;
  int range_px = 0;
  DisparityImage image;  ///< empty: no pair
};
using StereoDisparityPtr = std::shared_ptr<const StereoDisparity>;

class StereoStage : public Stage {
 public:
  enum Input : std::size_t { kTfStatic, kLeftInfo, kRightInfo, kLeft, kRight };
  explicit StereoStage(const StereoStageParams& params);

  void push(Stamp stamp, const StaticTransforms& transforms);
  void pushInfo(Input input, const CameraInfo& info);
  void pushImage(Input input, const ImagePtr& image);

  // Each one for every image of the left camera, at its stamp; empty when there is no right one for it.
  std::function<void(const StereoDisparityPtr&)> on_disparity;
  std::function<void(const ImagePtr&)> on_surface;      ///< mono8: 0 unknown, 127 obstacle, 255 road
  std::function<void(const ImagePtr&)> on_u_disparity;  ///< mono8: P(occupied) x 255, a row for each bin
  std::function<void(const SensorGridPtr&)> on_ground;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override { answerUpTo(merge().watermark()); }
  void onEnd() override { answerUpTo(kEndOfTime); }

 private:
  /// What depends on the calibration.
  struct Setup {
    Setup(const StereoStageParams& params, const CameraInfo& left_info, const CameraInfo& right_info,
          const std::optional<Pose>& T_left_right);
    CameraInfo left, right;  ///< as received
    Rectifier rectifier;
    StereoMatcher matcher;
    UDisparity u_disparity;
    StereoGround ground;
  };
  void answerUpTo(Stamp known);
  void answer(const ImagePtr& left, const ImagePtr& right);
  void answerNothing(const Image& left, Reason reason);
  [[nodiscard]] ImagePtr takeRight(Stamp left);
  [[nodiscard]] std::optional<Reason> prepare();
  void tell(const Image& left, const DisparityImage& disparity);

  StereoStageParams params_;
  Duration tolerance_;
  Rig rig_;
  std::optional<CameraInfo> left_info_, right_info_;
  std::deque<ImagePtr> lefts_, rights_;
  std::unique_ptr<Setup> setup_;
};

}  // namespace atlas
