// SPDX-License-Identifier: MIT
#include "atlas/lidar/obstacle_stage.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "atlas/lidar/clusters.hpp"
#include "atlas/lidar/ground.hpp"
#include "atlas/lidar/oriented_box.hpp"

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

/// All points of the sweeps within the range of the vehicle, in map; `time` relative to `stamp`.
std::vector<LidarPoint> nearPoints(const std::vector<BatchedSweepPtr>& sweeps,
                                   const Eigen::Vector3d& vehicle_map, Stamp stamp, double max_range_m) {
  std::size_t all = 0;
  for (const BatchedSweepPtr& sweep : sweeps) all += sweep->sweep->points.size();
  std::vector<LidarPoint> near;
  near.reserve(all);
  const double range_sq = max_range_m * max_range_m;
  for (const BatchedSweepPtr& sweep : sweeps) {
    const auto offset_s = static_cast<float>(toSeconds(sweep->stamp - stamp));
    std::vector<Eigen::Matrix<double, 3, 4>> T_map_lidar;
    for (const Batch& batch : sweep->batches) {
      T_map_lidar.emplace_back();
      T_map_lidar.back() << batch.T_map_lidar.rotation.toRotationMatrix(), batch.T_map_lidar.translation;
    }
    forEachPoint(*sweep, [&](std::size_t i, const Batch& batch) {
      const auto& T = T_map_lidar[static_cast<std::size_t>(&batch - sweep->batches.data())];
      LidarPoint p = sweep->sweep->points[i];
      const double x = p.x, y = p.y, z = p.z;
      const double map_x = T(0, 0) * x + T(0, 1) * y + T(0, 2) * z + T(0, 3),
                   map_y = T(1, 0) * x + T(1, 1) * y + T(1, 2) * z + T(1, 3);
      const double dx = map_x - vehicle_map.x(), dy = map_y - vehicle_map.y();
      if (!(dx * dx + dy * dy <= range_sq)) return;  // NaN ends here
      p.x = static_cast<float>(map_x);
      p.y = static_cast<float>(map_y);
      p.z = static_cast<float>(T(2, 0) * x + T(2, 1) * y + T(2, 2) * z + T(2, 3));
      p.time += offset_s;
      near.push_back(p);
    });
  }
  return near;
}

constexpr double kObjectLength_m = 8.0;  ///< boxes longer or wider than this are walls
constexpr double kObjectWidth_m = 3.0;
constexpr double kRoofGap_m = 0.8;  ///< rings apart on roofs and bonnets seen at a grazing angle

/// A strip of roof or bonnet: its middle lies over or in the other box, not as high as a crown above a car.
bool isPartOf(const Obstacle& small, const Obstacle& large) {
  const Eigen::Vector3d d = small.center - large.center;
  const double c = std::cos(large.yaw_rad), s = std::sin(large.yaw_rad);
  return large.size.x() <= kObjectLength_m && large.size.y() <= kObjectWidth_m &&
         std::abs(c * d.x() + s * d.y()) <= 0.5 * large.size.x() &&
         std::abs(-s * d.x() + c * d.y()) <= 0.5 * large.size.y() &&
         std::abs(d.z()) <= 0.5 * (small.size.z() + large.size.z()) + kRoofGap_m;
}

constexpr double kNarrowestCar_m = 1.2, kWidestCar_m = 2.2, kLongestCar_m = 5.2;
constexpr double kFaceDepth_m = 0.5;  ///< of what is seen of a front or a rear
constexpr double kBonnet_m = 1.5;     ///< between front and windscreen
constexpr double kAside_m = 0.4;      ///< of the middles of the two: each may be seen in part
constexpr double kOverlapUpwards_m = 0.25, kGapUpwards_m = 0.8;
constexpr double kSkewed = 0.26;  ///< sine of 15 deg

/// The front or rear of a car, and its cabin behind a bonnet that is seen at too grazing an angle to return
/// anything: equally wide, in line, the cabin higher and farther.
bool isFaceOf(const Obstacle& face, const Obstacle& cabin, const Eigen::Vector3d& vehicle_map) {
  const bool lengthwise = face.size.x() < face.size.y();  // its yaw is the car's
  const double depth_m = lengthwise ? face.size.x() : face.size.y(),
               width_m = lengthwise ? face.size.y() : face.size.x();
  if (depth_m > kFaceDepth_m || width_m < kNarrowestCar_m || width_m > kWidestCar_m) return false;
  const double yaw_rad = face.yaw_rad + (lengthwise ? 0.0 : 0.5 * M_PI);
  const Eigen::Vector3d along(std::cos(yaw_rad), std::sin(yaw_rad), 0.0), across(-along.y(), along.x(), 0.0),
      d = cabin.center - face.center;
  const double c = std::abs(std::cos(cabin.yaw_rad - yaw_rad)),
               s = std::abs(std::sin(cabin.yaw_rad - yaw_rad));
  const double cabin_length_m = c * cabin.size.x() + s * cabin.size.y(),
               cabin_width_m = s * cabin.size.x() + c * cabin.size.y();
  const double gap_m = std::abs(along.dot(d)) - 0.5 * (cabin_length_m + depth_m);
  const double up_m = d.z() - 0.5 * (cabin.size.z() + face.size.z());
  return std::min(c, s) <= kSkewed && cabin_width_m >= kNarrowestCar_m && cabin_width_m <= kWidestCar_m &&
         std::abs(across.dot(d)) <= kAside_m && gap_m <= kBonnet_m &&
         depth_m + gap_m + cabin_length_m <= kLongestCar_m && up_m >= -kOverlapUpwards_m &&
         up_m <= kGapUpwards_m &&
         along.dot(face.center - vehicle_map) * along.dot(d) > 0.0;  // the cabin is behind it
}

/// A box for each cluster; a cluster that is part of a larger one is given to it, the largest first.
std::vector<Obstacle> boxesOf(const std::vector<LidarPoint>& points,
                              std::vector<std::vector<std::uint32_t>>& clusters,
                              const Eigen::Vector3d& vehicle_map) {
  std::vector<Obstacle> boxes;
  for (const auto& members : clusters) boxes.push_back(*fitBox(points, members, vehicle_map));
  std::vector<std::size_t> by_size(clusters.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::size_t a, std::size_t b) { return boxes[a].points > boxes[b].points; });
  for (std::size_t i = 0; i < by_size.size(); ++i) {
    std::vector<std::uint32_t>& whole = clusters[by_size[i]];
    const std::size_t before = whole.size();
    for (std::size_t j = i + 1; j < by_size.size() && before > 0; ++j) {
      std::vector<std::uint32_t>& part = clusters[by_size[j]];
      const Obstacle &large = boxes[by_size[i]], &small = boxes[by_size[j]];
      if (part.empty() || !(isPartOf(small, large) || isFaceOf(small, large, vehicle_map) ||
                            isFaceOf(large, small, vehicle_map)))
        continue;
      whole.insert(whole.end(), part.begin(), part.end());
      part.clear();
    }
    if (whole.size() > before) boxes[by_size[i]] = *fitBox(points, whole, vehicle_map);
  }
  std::vector<Obstacle> kept;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    if (!clusters[i].empty()) kept.push_back(boxes[i]);
  }
  return kept;
}

ClusterParams clusterParams(const ObstacleParams& params) {
  ClusterParams result;
  result.tolerance_m = params.cluster_tolerance_m;
  result.tolerance_per_m = params.cluster_tolerance_per_m;
  result.step_m = params.cluster_step_m;
  result.step_per_m = params.cluster_step_per_m;
  return result;
}

}  // namespace

void validate(const ObstacleParams& p) {
  if (p.lidars.empty()) throw std::invalid_argument("obstacles: lidars must name at least one lidar");
  need(p.window_s > 0.0 && p.window_s <= 60.0, "window_s must lie in (0, 60]", p.window_s);
  need(p.max_range_m > 0.0 && p.max_range_m <= 500.0, "max_range_m must lie in (0, 500]", p.max_range_m);
  need(p.sweeps_per_lidar >= 1 && p.sweeps_per_lidar <= 100, "sweeps_per_lidar must lie in [1, 100]",
       p.sweeps_per_lidar);
  need(p.ground_cell_m >= 0.1 && p.ground_cell_m <= 10.0, "ground_cell_m must lie in [0.1, 10]",
       p.ground_cell_m);
  need(p.ground_tolerance_m > 0.0, "ground_tolerance_m must be positive", p.ground_tolerance_m);
  need(p.max_height_m > p.ground_tolerance_m, "max_height_m must exceed ground_tolerance_m", p.max_height_m);
  need(p.cluster_tolerance_m > 0.0, "cluster_tolerance_m must be positive", p.cluster_tolerance_m);
  need(p.cluster_tolerance_per_m >= 0.0, "cluster_tolerance_per_m must not be negative",
       p.cluster_tolerance_per_m);
  need(p.cluster_step_m > 0.0, "cluster_step_m must be positive", p.cluster_step_m);
  need(p.cluster_step_per_m >= 0.0, "cluster_step_per_m must not be negative", p.cluster_step_per_m);
  need(p.min_points >= 1, "min_points must be at least 1", p.min_points);
  need(p.max_points >= p.min_points, "max_points must not be below min_points", p.max_points);
}

ObstacleStage::ObstacleStage(const ObstacleParams& params)
    : Stage("obstacles", inputNames(params)),
      params_(params),
      trajectory_(kMaxPoseGap),
      windows_(params.lidars.size(), SweepWindow(fromSeconds(params.window_s))) {}

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
    windows_[lidar].push(batches);
    windows_[lidar].forget(batches->stamp);
    if (lidar != 0) return;
    counters_.add("sweeps");
    waiting_.push_back({batches->stamp, !batches->batches.empty(), newestOfEach(batches->stamp)});
    answerReady(batches->stamp);  // odometry of the same stamp comes first
  });
}

std::vector<BatchedSweepPtr> ObstacleStage::newestOfEach(Stamp stamp) {
  std::vector<BatchedSweepPtr> newest;
  for (SweepWindow& window : windows_) {
    window.forget(stamp);
    const auto& sweeps = window.sweeps();
    const std::size_t count = std::min(sweeps.size(), static_cast<std::size_t>(params_.sweeps_per_lidar));
    newest.insert(newest.end(), sweeps.end() - static_cast<std::ptrdiff_t>(count), sweeps.end());
  }
  return newest;
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
  std::vector<LidarPoint> points = nearPoints(sweeps, vehicle_map, stamp, params.max_range_m);
  GroundParams ground_params;
  ground_params.cell_m = params.ground_cell_m;
  ground_params.radius_m = params.max_range_m;
  ground_params.tolerance_m = params.ground_tolerance_m;
  const GroundGrid grid(points, vehicle_map, ground_params);

  std::vector<LidarPoint> raised;
  std::size_t on_ground = 0;
  for (const LidarPoint& point : points) {
    const double above_m = static_cast<double>(point.z) - grid.heightAt(point.x, point.y);
    if (std::abs(above_m) <= params.ground_tolerance_m) {
      points[on_ground++] = point;  // never beyond the point that is read
    } else if (above_m > 0.0 && above_m <= params.max_height_m) {
      raised.push_back(point);
    }
  }
  points.resize(on_ground);
  auto ground = std::make_shared<MapCloud>();
  ground->stamp = stamp;
  ground->points = std::move(points);
  Obstacles result;
  result.stamp = stamp;
  result.ground = ground;
  std::vector<std::vector<std::uint32_t>> clusters = findClusters(raised, vehicle_map, clusterParams(params));
  for (const Obstacle& box : boxesOf(raised, clusters, vehicle_map)) {
    if (box.points < static_cast<std::uint32_t>(params.min_points)) {
      counters.add("clusters below min_points");
    } else if (box.points > static_cast<std::uint32_t>(params.max_points)) {
      counters.add("clusters above max_points");
    } else {
      result.obstacles.push_back(box);
    }
  }
  counters.add("obstacles", result.obstacles.size());
  return result;
}

}  // namespace atlas
