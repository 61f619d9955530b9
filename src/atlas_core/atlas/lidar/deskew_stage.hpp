// SPDX-License-Identifier: MIT
// Stage: sweeps of all lidars and odometry in, sweeps cut into batches with one pose each out (paper IV-B,
// steps 1-3), or moved point by point into one batch. A sweep waits until the odometry has passed its last
// point: no pose is extrapolated and none is stale.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/lidar/batching.hpp"
#include "atlas/lidar/point_filter.hpp"
#include "atlas/lidar/point_time.hpp"
#include "atlas/lidar/vehicle_motion.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct DeskewParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  int batches_per_sweep = 100;  ///< N of the paper, 1..65535; 0 = every point by the pose at its own time
  double min_range_m = 1.0;     ///< nearer returns are the vehicle itself: set to NaN
  double max_range_m = 120.0;   ///< farther returns are set to NaN
  double max_pose_gap_s = 0.5;  ///< poses farther apart are not interpolated
  std::string motion = "velocities";    ///< within a sweep: the odometry's velocities, or its "poses"
  std::string scan_stamp = "recorded";  ///< what a sweep's stamp marks: see ScanStamp
  std::vector<double> vehicle_box_m;    ///< own body in the vehicle's frame, as vehicleBoxFrom takes it
  std::vector<int> dead_rings;          ///< broken beams, left out
  bool drop_duplicates = false;         ///< for sensors that report the same return twice
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const DeskewParams& params);

class DeskewStage : public Stage {
 public:
  /// Inputs: 0 tf_static, 1 odometry, 2 + i the points of params.lidars[i].
  enum Input : std::size_t { kTfStatic, kOdometry, kFirstLidar };

  explicit DeskewStage(const DeskewParams& params);

  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const Odometry& odometry);
  void push(std::size_t lidar, const SweepPtr& sweep);

  /// One per sweep, in stamp order over all lidars; without batches (and counted) when there was no pose.
  std::function<void(std::size_t lidar, const BatchedSweepPtr&)> on_batches;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override;
  void onEnd() override;

 private:
  struct Waiting {
    std::size_t lidar;
    SweepPtr sweep;
    Outcome<SweepSpan> span;
    Outcome<Pose> T_imu_lidar;  ///< as known when the sweep's turn came
  };
  void take(const Odometry& odometry);
  /// Answers from the front every sweep whose poses are known, or can no longer come: every odometry at or
  /// before `odometry_known` has been taken.
  void answerReady(Stamp odometry_known);
  [[nodiscard]] bool isReady(const Waiting& waiting, Stamp odometry_known) const;
  void answer(const Waiting& waiting);
  [[nodiscard]] Outcome<BatchedSweep> batched(const Waiting& waiting, const SweepPtr& points);
  void countCorrection(const Trajectory& poses, const SweepSpan& span);
  /// The points that are believed; counts the others.
  SweepPtr filtered(const Waiting& waiting);

  DeskewParams params_;
  ScanStamp scan_stamp_;
  PointFilter filter_;
  Duration max_pose_gap_;
  Rig rig_;
  VehicleMotion motion_;
  std::deque<Waiting> waiting_;  ///< in stamp order
};

}  // namespace atlas
