// SPDX-License-Identifier: MIT
// Stage: frustums of RGB detections projected into the thermal frame nearest in time (paper IV-D). An RGB
// image waits for the thermal frame after it, so "nearest" looks to both sides; a thermal frame is answered
// once no RGB image can choose it.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/camera/intrinsics_cache.hpp"
#include "atlas/camera/pose_history.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct ThermalParams {
  std::string thermal_camera = "camera_ir";
  std::vector<std::string> cameras = {"camera_left_front"};  ///< RGB cameras whose detections are moved
  double max_time_difference_s = 0.05;                       ///< between RGB image and thermal frame
  double min_box_px = 3.0;                                   ///< smaller boxes (after clipping) are dropped
  double min_visible_fraction = 0.3;  ///< of the box area that must stay after clipping
  double max_pose_gap_s = 0.5;
};
void validate(const ThermalParams& params);

class ThermalStage : public Stage {
 public:
  /// Inputs: 0 tf_static, 1 odometry, 2 camera_info of the thermal camera, 3 + i frustums of
  /// params.cameras[i].
  enum Input : std::size_t { kTfStatic, kOdometry, kThermalInfo, kFirstCamera };
  explicit ThermalStage(const ThermalParams& params);
  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const Odometry& odometry);
  void pushThermal(const CameraInfo& info);
  void push(std::size_t camera, const Frustums& frustums);

  /// One per thermal frame, in order.
  std::function<void(const ProjectedDetections&)> on_projected;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override;
  void onEnd() override;

 private:
  struct Source {
    std::size_t camera;
    Frustums frustums;
  };
  struct ThermalFrame {
    CameraInfo info;
    std::uint32_t index;
    Outcome<Pose> T_imu_thermal;    ///< as known at the frame's turn
    std::vector<Source> chosen_by;  ///< at most one per camera: the RGB image nearest in time
  };
  /// Gives the frustums whose nearest frame is certain to that frame.
  void assign();
  /// Index in frames_ of the frame nearest to `stamp` (ties: the earlier); nullopt when it is too far away.
  [[nodiscard]] std::optional<std::size_t> nearestFrame(Stamp stamp) const;
  void choose(ThermalFrame& frame, Source source);
  /// No frustum can choose the oldest frame any more.
  [[nodiscard]] bool oldestIsSettled() const;
  void answerReady();
  void answer(const ThermalFrame& frame, const Outcome<Pose>& T_map_imu);
  void projectInto(ProjectedDetections& result, const Source& source, const CameraModel& model,
                   const Pose& T_thermal_map);

  ThermalParams params_;
  Duration max_difference_;
  Rig rig_;
  PoseHistory poses_;
  IntrinsicsCache intrinsics_;
  std::uint32_t next_index_ = 0;
  std::deque<ThermalFrame> frames_;  ///< not answered yet
  std::deque<Source> pending_;       ///< frustums whose nearest frame is not known yet, in merged order
};

}  // namespace atlas
