// SPDX-License-Identifier: MIT
// Stage: for every frame of a camera (its camera_info is the trigger) the aggregated cloud projected into it
// (paper IV-E), and into a virtual camera whenever the first one has a frame.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/camera/camera_window.hpp"
#include "atlas/camera/depth_buffer.hpp"
#include "atlas/camera/intrinsics_cache.hpp"
#include "atlas/camera/pose_history.hpp"
#include "atlas/camera/virtual_camera.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct DepthParams {
  std::vector<std::string> cameras = {"camera_ir"};
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  double window_s = 0.5;  ///< lidar sweeps used: stamp in (image - window, image + look_ahead]
  /// A sweep ends after most of its points were measured: the image waits for the one that was under way.
  double look_ahead_s = 0.1;
  double recent_s = 0.05;  ///< points measured so near in time to the image tell what has moved
  double min_depth_m = 0.5;
  double max_depth_m = 100.0;
  bool hide_occluded = true;   ///< remove what shines through nearer surfaces, and what has moved away
  double line_gap_deg = 1.5;   ///< largest angle between two scan lines, a little above the lidar's own
  double surface_step = 0.03;  ///< share of the depth from which two depths are two surfaces
  double fill_gap_m = 0.3;     ///< gaps between points of a surface are filled up to this, 0 = none
  double max_pose_gap_s = 0.5;
  VirtualCameraParams virtual_camera;  ///< its images come after those of the first camera
  /// Of all images: those of `cameras`, then the virtual one if there is one.
  [[nodiscard]] std::vector<std::string> names() const;
};
void validate(const DepthParams& params);

class DepthStage : public Stage {
 public:
  /// Inputs: 0 tf_static, 1 odometry, then batches of each lidar, then camera_info of each camera.
  enum Input : std::size_t { kTfStatic, kOdometry, kFirstLidar };
  [[nodiscard]] std::size_t lidarInput(std::size_t i) const { return kFirstLidar + i; }
  [[nodiscard]] std::size_t cameraInfoInput(std::size_t c) const {
    return kFirstLidar + params_.lidars.size() + c;
  }

  explicit DepthStage(const DepthParams& params);
  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const Odometry& odometry);
  void push(std::size_t lidar, const BatchedSweepPtr& batches);
  void push(std::size_t camera, const CameraInfo& info);

  /// One per camera_info, in stamp order over all cameras; all NaN when there was no pose or no cloud, an
  /// empty Mat when the camera_info is unusable (counted). `camera`: index in params.names().
  std::function<void(std::size_t camera, const DepthImagePtr&)> on_depth;
  /// Before each of them: how far to believe it. `depth` holds 1 where a point was measured, 0 where nothing
  /// is known, between where a gap was filled (fillGaps); an empty Mat when the image has no depth.
  std::function<void(std::size_t camera, const DepthImagePtr&)> on_confidence;
  /// Before each image: what it is made from.
  std::function<void(const ProductOrigins&)> on_origins;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override;
  void onEnd() override;

 private:
  struct Waiting {
    std::size_t camera;
    std::uint32_t image_index;
    CameraInfo info;
    Outcome<Pose> T_imu_camera;           ///< as known at the image's turn
    std::vector<CompactSweepPtr> sweeps;  ///< the window at the image's turn, and those that came since
  };
  void take(std::size_t camera, const CameraInfo& info, std::uint32_t image_index,
            const Outcome<Pose>& T_imu_camera);
  void answerReady();
  void answer(const Waiting& waiting, const Outcome<Pose>& T_map_imu);
  /// kNoPoints when no sweep of the window has a pose.
  Outcome<DepthBuffer::Images> render(const Waiting& waiting, const Intrinsics& intrinsics,
                                      const Outcome<Pose>& T_map_imu);

  DepthParams params_;
  std::vector<std::string> names_;
  Rig rig_;
  Duration look_ahead_;
  PoseHistory poses_;
  CameraWindow window_;
  SweepOrigins sweep_origins_;
  std::vector<IntrinsicsCache> intrinsics_;            ///< per camera
  std::vector<std::uint32_t> image_count_;             ///< per camera: index of its next image
  std::vector<std::unique_ptr<DepthBuffer>> buffers_;  ///< per camera, from its first image on; empty between
  std::deque<Waiting> waiting_;                        ///< in merged order
};

}  // namespace atlas
