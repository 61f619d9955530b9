// SPDX-License-Identifier: MIT
// Stage: batches of lidars, grids of stereo pairs and odometry in; occupancy grid with velocities, objects
// and collision risk out. Measurements that are close in time make one update together, whichever sensors
// they are of: a sensor that is silent is just not part of it.
#pragma once

#include <deque>
#include <functional>
#include <optional>

#include "atlas/base/stage.hpp"
#include "atlas/base/trajectory.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/grid/occupancy_chain.hpp"

namespace atlas {

class OccupancyStage : public Stage {
 public:
  /// Inputs: tf_static, odometry, batches of each lidar, grid of each stereo pair: at one stamp in this
  /// order.
  enum Input : std::size_t { kTfStatic, kOdometry, kFirstLidar };
  [[nodiscard]] std::size_t stereoInput(std::size_t i) const {
    return kFirstLidar + params_.lidars.size() + i;
  }

  explicit OccupancyStage(const OccupancyParams& params);
  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const Odometry& odometry);
  void push(std::size_t lidar, const BatchedSweepPtr& batches);
  void push(std::size_t stereo, const SensorGridPtr& grid);

  /// One for each group of measurements, at the stamp of the newest of them; every sweep and stereo grid is
  /// in one group. Without cells when the vehicle's pose is not known.
  std::function<void(const OccupancyFramePtr&)> on_frame;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override;
  void onEnd() override;

 private:
  struct Group {
    Stamp first = 0, last = 0;
    std::vector<BatchedSweepPtr> sweeps;  ///< by lidar, null: none
    std::vector<SensorGridPtr> grids;     ///< by stereo pair, null: none
  };
  Group& groupFor(Stamp stamp);
  void closeBefore(Stamp stamp);
  void close();
  void answerReady(Stamp odometry_known);
  void answer(const Group& group);

  OccupancyParams params_;
  Rig rig_;
  Trajectory trajectory_;
  std::deque<Odometry> motions_;  ///< as far back as a group may ask
  OccupancyChain chain_;
  std::optional<Group> open_;
  std::deque<Group> waiting_;  ///< for the pose
};

}  // namespace atlas
