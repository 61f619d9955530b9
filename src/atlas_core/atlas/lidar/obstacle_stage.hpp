// SPDX-License-Identifier: MIT
// Stage: batches and odometry in, ground and oriented obstacle boxes out, once per sweep of the first lidar.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/base/trajectory.hpp"
#include "atlas/lidar/sweep_window.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct ObstacleParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  double window_s = 0.15;                 ///< no older sweep is looked at
  int sweeps_per_lidar = 1;               ///< newest of the window: more of them blur what moves
  double max_range_m = 40.0;              ///< around the vehicle
  double ground_cell_m = 1.0;             ///< grid of the ground estimate
  double ground_tolerance_m = 0.25;       ///< points nearer to the ground than this belong to it
  double max_height_m = 4.0;              ///< above ground; higher points are ignored
  double cluster_tolerance_m = 0.3;       ///< horizontal gap inside a cluster, at the vehicle
  double cluster_tolerance_per_m = 0.02;  ///< added for each metre of range: beams spread
  double cluster_step_m = 0.35;           ///< the same for gaps in height
  double cluster_step_per_m = 0.02;
  int min_points = 8;       ///< per cluster
  int max_points = 100000;  ///< per cluster
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const ObstacleParams& params);

class ObstacleStage : public Stage {
 public:
  /// Inputs: 0 odometry, 1 + i batches of params.lidars[i].
  enum Input : std::size_t { kOdometry, kFirstLidar };
  explicit ObstacleStage(const ObstacleParams& params);
  void push(const Odometry& odometry);
  void push(std::size_t lidar, const BatchedSweepPtr& batches);
  std::function<void(const Obstacles&)>
      on_obstacles;  ///< stamp of the triggering sweep; empty when there was no pose

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override;
  void onEnd() override;

 private:
  struct Waiting {
    Stamp stamp;
    bool has_pose;                        ///< the triggering sweep has batches
    std::vector<BatchedSweepPtr> sweeps;  ///< the window at `stamp`
  };
  /// Sweeps of the window at `stamp`, at most sweeps_per_lidar of each lidar; lidar by lidar, oldest first.
  [[nodiscard]] std::vector<BatchedSweepPtr> newestOfEach(Stamp stamp);
  void answerReady(Stamp odometry_known);
  void answer(const Waiting& waiting);

  ObstacleParams params_;
  Trajectory trajectory_;
  std::vector<SweepWindow> windows_;  ///< by lidar
  std::deque<Waiting> waiting_;
};

/// Ground and obstacles of the sweeps; `vehicle_map` is the vehicle's position. Clusters outside [min_points,
/// max_points] are counted, not returned. Obstacles in order of their first point.
[[nodiscard]] Obstacles findObstacles(const std::vector<BatchedSweepPtr>& sweeps,
                                      const Eigen::Vector3d& vehicle_map, Stamp stamp,
                                      const ObstacleParams& params, Counters& counters);

}  // namespace atlas
