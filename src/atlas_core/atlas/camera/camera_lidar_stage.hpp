// SPDX-License-Identifier: MIT
// Stage: 2D detections become 3D frustums by the lidar points seen through their boxes (paper IV-C).
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/camera/camera_window.hpp"
#include "atlas/camera/intrinsics_cache.hpp"
#include "atlas/camera/pose_history.hpp"
#include "atlas/sensor/products.hpp"
#include "atlas/sensor/sensor_gate.hpp"

namespace atlas {

struct CameraLidarParams {
  std::vector<std::string> cameras = {"camera_left_front", "camera_left_side", "camera_right_front",
                                      "camera_right_side"};
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  std::string method = "foreground";  ///< or "median", the paper's: of everything inside the box
  double window_s = 0.5;              ///< lidar sweeps used: stamp in (image - window, image + look_ahead]
  /// A sweep ends after most of its points were measured: the image waits for the one that was under way.
  double look_ahead_s = 0.1;
  double recent_s =
      0.05;  ///< foreground: points so near in time to the image count alone when there are enough
  double max_depth_m = 80.0;
  int min_points = 3;           ///< fewer points give no distance (the detection is counted as skipped)
  double object_depth_m = 1.0;  ///< far plane = near plane + this, for median; else where its points end
  double max_pose_gap_s = 0.5;
  double merge_within_s = 0.03;  ///< images of different cameras so near in time show the same objects
  SensorLimits gate_on_sensors;  ///< detections of cameras below get no frustums
};
void validate(const CameraLidarParams& params);

class CameraLidarStage : public Stage {
 public:
  /// Inputs: 0 tf_static, 1 odometry, then batches of each lidar, then camera_info of each camera, then
  /// sensor_status with a gate, then detections of each camera.
  enum Input : std::size_t { kTfStatic, kOdometry, kFirstLidar };
  [[nodiscard]] std::size_t lidarInput(std::size_t i) const { return kFirstLidar + i; }
  [[nodiscard]] std::size_t cameraInfoInput(std::size_t c) const {
    return kFirstLidar + params_.lidars.size() + c;
  }
  [[nodiscard]] std::size_t gateInput() const { return cameraInfoInput(params_.cameras.size()); }
  [[nodiscard]] std::size_t detectionsInput(std::size_t c) const {
    return gateInput() + (params_.gate_on_sensors.empty() ? 0 : 1) + c;
  }

  explicit CameraLidarStage(const CameraLidarParams& params);
  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const Odometry& odometry);
  void push(std::size_t lidar, const BatchedSweepPtr& batches);
  void push(std::size_t camera, const CameraInfo& info);
  void push(std::size_t camera, const Detections& detections);
  void push(const SensorStatus& status);

  /// One per Detections, in order per camera; without frustums when there was no pose, intrinsics or points.
  std::function<void(std::size_t camera, const Frustums&)> on_frustums;
  /// Of all cameras, objects that several of them see once (mergeDuplicates): one for each group of images
  /// that are at most merge_within_s after its first.
  std::function<void(const Frustums&)> on_merged;
  /// Before each answer of a camera: what it is made from. A frustum names its detection itself.
  std::function<void(const ProductOrigins&)> on_origins;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override;
  void onEnd() override;

 private:
  struct Waiting {
    std::size_t camera;
    Detections detections;
    std::optional<CameraInfo> info;       ///< newest at the image's turn
    bool trusted;                         ///< by the gate, at the image's turn
    Outcome<Pose> T_imu_camera;           ///< as known at the image's turn
    std::vector<CompactSweepPtr> sweeps;  ///< the window at the image's turn, and those that came since
  };
  void take(std::size_t camera, const Detections& detections);
  void answerReady();
  /// Answers the oldest detections that wait; false when that is not possible yet.
  bool answerOldest();
  void mergeGroup();
  void answer(const Waiting& waiting, const Outcome<Pose>& T_map_imu);
  std::vector<Frustum> frustumsOf(const Waiting& waiting, const Intrinsics& intrinsics,
                                  const Pose& T_map_camera);

  CameraLidarParams params_;
  Rig rig_;
  SensorGate gate_;
  Duration look_ahead_;
  PoseHistory poses_;
  CameraWindow window_;
  SweepOrigins sweep_origins_;
  std::vector<std::optional<CameraInfo>> camera_info_;  ///< newest per camera
  std::vector<IntrinsicsCache> intrinsics_;             ///< per camera
  std::deque<Waiting> waiting_;                         ///< in merged order
  std::vector<Frustums> group_;                         ///< answered, not merged yet
  std::uint32_t merged_count_ = 0;
};

}  // namespace atlas
