// SPDX-License-Identifier: MIT
#include "atlas/lidar/obstacle_stage.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "atlas/lidar/batched_points.hpp"
#include "atlas/lidar/clusters.hpp"
#include "atlas/lidar/ground.hpp"
#include "atlas/lidar/oriented_box.hpp"
#include "atlas/lidar/voxel.hpp"

namespace atlas {
namespace {

constexpr Duration kMaxPoseGap = kSecond / 2;

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("obstacles: " + what + ", got " + std::to_string(value));
}

std::vector<std::string> inputNames(const ObstacleParams& params) {
  validate(params);
  std::vector<std::string> names = {"odometry"};
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  return names;
}

/// One point per voxel of all sweeps, within the range of the vehicle.
std::vector<LidarPoint> thinned(const std::vector<BatchedSweepPtr>& sweeps,
                                const Eigen::Vector3d& vehicle_map, Stamp stamp,
                                const ObstacleParams& params) {
  std::size_t points = 0;
  for (const BatchedSweepPtr& sweep : sweeps) points += sweep->sweep->points.size();
  VoxelFilter filter(params.voxel_m, VoxelPoint::kFirst, points / 4);
  const double range_sq = params.max_range_m * params.max_range_m;
  for (const BatchedSweepPtr& sweep : sweeps) {
    const MapCloud cloud = inMap(*sweep);
    const auto offset_s = static_cast<float>(toSeconds(sweep->stamp - stamp));
    for (LidarPoint point : cloud.points) {
      const double dx = point.x - vehicle_map.x(), dy = point.y - vehicle_map.y();
      if (!(dx * dx + dy * dy <= range_sq)) continue;  // NaN ends here
      point.time += offset_s;
      filter.add(point);
    }
  }
  return filter.take();
}

}  // namespace

void validate(const ObstacleParams& p) {
  if (p.lidars.empty()) throw std::invalid_argument("obstacles: lidars must name at least one lidar");
  need(p.window_s > 0.0 && p.window_s <= 60.0, "window_s must lie in (0, 60]", p.window_s);
  need(p.max_range_m > 0.0 && p.max_range_m <= 500.0, "max_range_m must lie in (0, 500]", p.max_range_m);
  need(p.voxel_m > 0.0 && p.voxel_m <= 10.0, "voxel_m must lie in (0, 10]", p.voxel_m);
  need(p.ground_cell_m >= 0.1 && p.ground_cell_m <= 10.0, "ground_cell_m must lie in [0.1, 10]",
       p.ground_cell_m);
  need(p.ground_tolerance_m > 0.0, "ground_tolerance_m must be positive", p.ground_tolerance_m);
  need(p.max_height_m > p.ground_tolerance_m, "max_height_m must exceed ground_tolerance_m", p.max_height_m);
  need(p.cluster_tolerance_m > 0.0, "cluster_tolerance_m must be positive", p.cluster_tolerance_m);
  need(p.min_points >= 1, "min_points must be at least 1", p.min_points);
  need(p.max_points >= p.min_points, "max_points must not be below min_points", p.max_points);
}

ObstacleStage::ObstacleStage(const ObstacleParams& params)
    : Stage("obstacles", inputNames(params)),
      params_(params),
      trajectory_(kMaxPoseGap),
      window_(fromSeconds(params.window_s)) {}

void ObstacleStage::push(const Odometry& odometry) {
  enqueue(kOdometry, odometry.stamp, [this, odometry] {
    const Pose& T_map_imu = odometry.T_map_imu;
    const bool again = !trajectory_.empty() && odometry.stamp <= trajectory_.poses().back().stamp;
    if (again || !T_map_imu.translation.allFinite() || !T_map_imu.rotation.coeffs().allFinite()) {
      counters_.skip("odometry", again ? Reason::kOutOfOrder : Reason::kNotFinite);
      return;
    }
    answerReady(odometry.stamp - 1);
    trajectory_.push({odometry.stamp, T_map_imu});
    answerReady(odometry.stamp - 1);
    trajectory_.forgetBefore(
        odometry.stamp);  // what waits is older than nothing: its pose was asked for above
  });
}

void ObstacleStage::push(std::size_t lidar, const BatchedSweepPtr& batches) {
  enqueue(kFirstLidar + lidar, batches->stamp, [this, lidar, batches] {
    window_.push(batches);
    window_.forget(batches->stamp);
    if (lidar != 0) return;
    counters_.add("sweeps");
    waiting_.push_back(
        {batches->stamp, !batches->batches.empty(), {window_.sweeps().begin(), window_.sweeps().end()}});
    answerReady(batches->stamp);  // odometry of the same stamp comes first
  });
}

void ObstacleStage::answerReady(Stamp odometry_known) {
  while (!waiting_.empty()) {
    const Waiting& front = waiting_.front();
    const bool reached = !trajectory_.empty() && trajectory_.poses().back().stamp >= front.stamp;
    if (front.has_pose && !reached && odometry_known < front.stamp + kMaxPoseGap) return;
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    answer(waiting);
  }
}

void ObstacleStage::answer(const Waiting& waiting) {
  Obstacles result;
  result.stamp = waiting.stamp;
  const Outcome<Pose> T_map_imu = trajectory_.at(waiting.stamp);
  if (waiting.has_pose && T_map_imu) {
    result = findObstacles(waiting.sweeps, T_map_imu->translation, waiting.stamp, params_, counters_);
  } else {
    counters_.skip("sweep", waiting.has_pose ? T_map_imu.reason() : Reason::kNoPoseYet);
  }
  if (on_obstacles) on_obstacles(result);
}

Stamp ObstacleStage::heldBackFrom() const { return waiting_.empty() ? kEndOfTime : waiting_.front().stamp; }

void ObstacleStage::onProgress() { answerReady(merge().watermark()); }

void ObstacleStage::onEnd() { answerReady(kEndOfTime); }

Obstacles findObstacles(const std::vector<BatchedSweepPtr>& sweeps, const Eigen::Vector3d& vehicle_map,
                        Stamp stamp, const ObstacleParams& params, Counters& counters) {
  const std::vector<LidarPoint> points = thinned(sweeps, vehicle_map, stamp, params);
  GroundParams ground_params;
  ground_params.cell_m = params.ground_cell_m;
  ground_params.radius_m = params.max_range_m;
  ground_params.tolerance_m = params.ground_tolerance_m;
  const GroundGrid grid(points, vehicle_map, ground_params);

  auto ground = std::make_shared<MapCloud>();
  ground->stamp = stamp;
  std::vector<LidarPoint> raised;
  for (const LidarPoint& point : points) {
    const double above_m = static_cast<double>(point.z) - grid.heightAt(point.x, point.y);
    if (std::abs(above_m) <= params.ground_tolerance_m) ground->points.push_back(point);
    if (above_m > params.ground_tolerance_m && above_m <= params.max_height_m) raised.push_back(point);
  }
  Obstacles result;
  result.stamp = stamp;
  result.ground = ground;
  for (const std::vector<std::uint32_t>& members : euclideanClusters(raised, params.cluster_tolerance_m)) {
    if (members.size() < static_cast<std::size_t>(params.min_points)) {
      counters.add("clusters below min_points");
    } else if (members.size() > static_cast<std::size_t>(params.max_points)) {
      counters.add("clusters above max_points");
    } else {
      result.obstacles.push_back(*fitBox(raised, members));
    }
  }
  counters.add("obstacles", result.obstacles.size());
  return result;
}

}  // namespace atlas
