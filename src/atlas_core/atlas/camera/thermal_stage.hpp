// SPDX-License-Identifier: MIT
// Stage: frustums of RGB detections projected into the thermal frame nearest in time (paper IV-D). An RGB
// image waits for the thermal frame after it, so "nearest" looks to both sides, and for the next image of its
// camera, which tells how objects move and which of them the detector missed (followObjects). A thermal frame
// is answered once no RGB image can choose it and the lidar has seen what may hide an object.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/camera/camera_window.hpp"
#include "atlas/camera/frustum_motion.hpp"
#include "atlas/camera/intrinsics_cache.hpp"
#include "atlas/camera/pose_history.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct ThermalParams {
  std::string thermal_camera = "camera_ir";
  std::vector<std::string> cameras = {"camera_left_front"};  ///< RGB cameras whose detections are moved
  std::vector<std::string> lidars = {"lidar_left",
                                     "lidar_right"};  ///< that see what hides an object; may be empty
  double max_time_difference_s = 0.05;                ///< between RGB image and thermal frame
  /// Images of a camera so near in time show the same objects; 0: each image stands alone.
  double neighbour_s = 0.15;
  double bridged_confidence = 0.5;    ///< of an object missed in one image, as share of its neighbours'
  double min_box_px = 3.0;            ///< smaller boxes (after clipping) are dropped
  double min_visible_fraction = 0.3;  ///< of the box area that must stay after clipping
  double max_hidden_fraction = 0.7;   ///< of the box in front of which the lidar sees something nearer
  double look_ahead_s = 0.1;          ///< a box waits for the sweep that was under way
  double recent_s = 0.05;             ///< points measured so near in time to the thermal frame are looked at
  double max_pose_gap_s = 0.5;
};
void validate(const ThermalParams& params);

class ThermalStage : public Stage {
 public:
  /// Inputs: 0 tf_static, 1 odometry, 2 camera_info of the thermal camera, 3 + i frustums of
  /// params.cameras[i], then batches of each lidar.
  enum Input : std::size_t { kTfStatic, kOdometry, kThermalInfo, kFirstCamera };
  [[nodiscard]] std::size_t lidarInput(std::size_t i) const {
    return kFirstCamera + params_.cameras.size() + i;
  }
  explicit ThermalStage(const ThermalParams& params);
  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const Odometry& odometry);
  void pushThermal(const CameraInfo& info);
  void push(std::size_t camera, const Frustums& frustums);
  void push(std::size_t lidar, const BatchedSweepPtr& batches);

  /// One per thermal frame, in order.
  std::function<void(const ProjectedDetections&)> on_projected;
  /// Before each of them: what it is made from.
  std::function<void(const ProductOrigins&)> on_origins;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override;
  void onEnd() override;

 private:
  /// An image and the objects in it.
  struct Source {
    std::size_t camera;
    Stamp stamp;
    std::vector<MovingFrustum> objects;
    std::vector<Origin> origins;  ///< the frustums of this image, and of its neighbours in time
  };
  struct Pending {
    std::size_t camera;
    Frustums frustums;
  };
  struct ThermalFrame {
    CameraInfo info;
    std::uint32_t index;
    Outcome<Pose> T_imu_thermal;          ///< as known at the frame's turn
    std::vector<CompactSweepPtr> sweeps;  ///< the window at the frame's turn, and those that came since
    std::vector<Source> chosen_by;        ///< at most one per camera: the RGB image nearest in time
  };
  /// A label that is in the image, and the z-depth of the front of its object.
  struct Label {
    Detection2d box;
    std::uint32_t source_index;
    double front_m;
  };
  /// Gives the frustums whose nearest frame is certain to that frame.
  void assign();
  /// The next image of the camera of the oldest pending one; null when there is none near in time. nullopt
  /// while it may still come.
  [[nodiscard]] std::optional<const Frustums*> imageAfterOldest() const;
  Source takeOldest(const Frustums* after);
  /// Index in frames_ of the frame nearest to `stamp` (ties: the earlier); nullopt when it is too far away.
  [[nodiscard]] std::optional<std::size_t> nearestFrame(Stamp stamp) const;
  void choose(ThermalFrame& frame, Source source);
  /// No frustum can choose the oldest frame any more, and all sweeps that it needs have come.
  [[nodiscard]] bool oldestIsSettled() const;
  void answerReady();
  void answer(const ThermalFrame& frame, const Outcome<Pose>& T_map_imu);
  void tellOrigins(const ThermalFrame& frame) const;
  std::vector<Label> project(const ThermalFrame& frame, const Source& source, const CameraModel& model,
                             const Pose& T_thermal_map);
  void dropHidden(std::vector<Label>& labels, const ThermalFrame& frame, const Projector& projector,
                  const Pose& T_thermal_map);

  ThermalParams params_;
  Duration max_difference_, neighbour_, look_ahead_;
  Rig rig_;
  PoseHistory poses_;
  CameraWindow window_;
  SweepOrigins sweep_origins_;
  IntrinsicsCache intrinsics_;
  std::uint32_t next_index_ = 0;
  std::deque<ThermalFrame> frames_;  ///< not answered yet
  std::deque<Pending>
      pending_;  ///< images whose neighbour or nearest frame is not known yet, in merged order
  std::vector<std::optional<Frustums>> before_;  ///< per camera: its last image that is no longer pending
};

}  // namespace atlas
