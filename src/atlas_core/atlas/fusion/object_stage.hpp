// SPDX-License-Identifier: MIT
// Stage: obstacles, frustums of all cameras and radar targets become objects with an identity (the objects
// aggregator of the paper's Local Map). Sensors that are not there are just not heard of.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/fusion/object_tracker.hpp"
#include "atlas/fusion/radar_sign.hpp"
#include "atlas/fusion/range_view.hpp"

namespace atlas {

struct ObjectParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  std::vector<std::string> radars = {"radar_ti"};
  bool use_frustums = true;         ///< false: cameras are not listened to
  double max_range_m = 40.0;        ///< as that of the obstacles: nothing is missed beyond
  double max_odometry_age_s = 0.1;  ///< of the pose of a radar scan
  double max_silence_s = 0.15;      ///< without obstacles for so long, other sensors' scans are answered
  TrackerParams tracker;
};
void validate(const ObjectParams& params);

class ObjectStage : public Stage {
 public:
  /// Inputs: tf_static, odometry, batches of each lidar, obstacles, frustums, scans of each radar: at one
  /// stamp in this order.
  enum Input : std::size_t { kTfStatic, kOdometry, kFirstLidar };
  [[nodiscard]] std::size_t obstaclesInput() const { return kFirstLidar + params_.lidars.size(); }
  [[nodiscard]] std::size_t frustumsInput() const { return obstaclesInput() + 1; }
  [[nodiscard]] std::size_t radarInput(std::size_t i) const {
    return obstaclesInput() + (params_.use_frustums ? 2 : 1) + i;
  }

  explicit ObjectStage(const ObjectParams& params);
  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const Odometry& odometry);
  void push(std::size_t lidar, const BatchedSweepPtr& batches);
  void push(const Obstacles& obstacles);
  void push(const Frustums& frustums);
  void push(std::size_t radar, const RadarScan& scan);

  /// One for each Obstacles, at its stamp; without any for max_silence_s, one for each scan of another
  /// sensor.
  std::function<void(const ObjectsPtr&)> on_objects;

 private:
  void take(const Obstacles& obstacles);
  void take(const Frustums& frustums);
  void take(std::size_t radar, const RadarScan& scan);
  void answer(Stamp stamp);
  void answerIfSilent(Stamp stamp);
  [[nodiscard]] std::optional<Eigen::Vector3d> lidarOrigin() const;
  [[nodiscard]] double detectability(const TrackShape& object, Stamp stamp) const;

  ObjectParams params_;
  Rig rig_;
  ObjectTracker tracker_;
  std::optional<Odometry> odometry_;             ///< newest
  std::vector<std::optional<RangeView>> views_;  ///< newest of each lidar
  std::vector<RadarSign> radar_signs_;
  Stamp answered_ = kBeginOfTime;
};

}  // namespace atlas
