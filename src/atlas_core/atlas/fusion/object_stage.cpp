// SPDX-License-Identifier: MIT
#include "atlas/fusion/object_stage.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "atlas/fusion/box_measurement.hpp"
#include "atlas/fusion/point_measurement.hpp"

namespace atlas {
namespace {

constexpr double kFound = 0.85;          ///< share of objects in full view that have an obstacle
constexpr double kNothingThrough = 0.3;  ///< weight of a cell without a return: it may be a dark surface
constexpr int kFewestCells = 3;          ///< of an object that a sweep can tell anything about
constexpr double kViewAge_s = 0.25;

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("objects: " + what + ", got " + std::to_string(value));
}

std::vector<std::string> inputNames(const ObjectParams& params) {
  validate(params);
  std::vector<std::string> names = {"tf_static", "odometry"};
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  names.emplace_back("obstacles");
  if (params.use_frustums) names.emplace_back("frustums");
  for (const std::string& radar : params.radars) names.push_back(radar + "/scan");
  return names;
}

}  // namespace

void validate(const ObjectParams& p) {
  need(p.max_range_m > 0.0 && p.max_range_m <= 500.0, "max_range_m must lie in (0, 500]", p.max_range_m);
  need(p.max_odometry_age_s > 0.0, "max_odometry_age_s must be positive", p.max_odometry_age_s);
  need(p.max_silence_s > 0.0, "max_silence_s must be positive", p.max_silence_s);
  validate(p.tracker);
}

ObjectStage::ObjectStage(const ObjectParams& params)
    : Stage("objects", inputNames(params)),
      params_(params),
      tracker_(params.tracker),
      views_(params.lidars.size()),
      radar_signs_(params.radars.size()) {}

void ObjectStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}

void ObjectStage::push(const Odometry& odometry) {
  enqueue(kOdometry, odometry.stamp, [this, odometry] {
    if (odometry.T_map_imu.translation.allFinite() && odometry.T_map_imu.rotation.coeffs().allFinite()) {
      odometry_ = odometry;
    } else {
      counters_.skip("odometry", Reason::kNotFinite);
    }
  });
}

void ObjectStage::push(std::size_t lidar, const BatchedSweepPtr& batches) {
  enqueue(kFirstLidar + lidar, batches->stamp, [this, lidar, batches] {
    RangeView view(*batches);
    if (!view.empty()) views_[lidar] = std::move(view);
  });
}
void ObjectStage::push(const Obstacles& obstacles) {
  enqueue(obstaclesInput(), obstacles.stamp, [this, obstacles] { take(obstacles); });
}
void ObjectStage::push(const Frustums& frustums) {
  enqueue(frustumsInput(), frustums.stamp, [this, frustums] { take(frustums); });
}
void ObjectStage::push(std::size_t radar, const RadarScan& scan) {
  enqueue(radarInput(radar), scan.stamp, [this, radar, scan] { take(radar, scan); });
}

std::optional<Eigen::Vector3d> ObjectStage::lidarOrigin() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto& view : views_) {
    if (!view) continue;
    sum += view->origin();
    ++count;
  }
  if (count > 0) return sum / count;
  if (odometry_) return odometry_->T_map_imu.translation;
  return std::nullopt;
}

double ObjectStage::detectability(const TrackShape& object, Stamp stamp) const {
  double most = 0.0;
  for (const auto& view : views_) {
    if (!view || toSeconds(stamp - view->stamp()) > kViewAge_s) continue;
    const double distance = (object.position() - view->origin().head<2>()).norm();
    if (distance > params_.max_range_m - 1.0) continue;
    const RangeView::Census c = view->census(object);
    const double through = c.through + kNothingThrough * c.nothing, all = through + c.there + c.hidden;
    if (all >= kFewestCells) most = std::max(most, kFound * through / all);
  }
  return most;
}

void ObjectStage::take(const Obstacles& obstacles) {
  const auto origin = lidarOrigin();
  if (!origin) {
    counters_.skip("obstacles", Reason::kNoPoseYet);
    return answer(obstacles.stamp);
  }
  Scan scan;
  scan.stamp = obstacles.stamp;
  scan.input = "obstacles";
  for (std::size_t i = 0; i < obstacles.obstacles.size(); ++i) {
    const Obstacle& box = obstacles.obstacles[i];
    SeenBox::Hidden hidden;
    for (const auto& view : views_) {
      if (!view) continue;
      const RangeView::Sides sides = view->hiddenSides(box);
      hidden.left = hidden.left || sides.left;
      hidden.right = hidden.right || sides.right;
    }
    auto measurement = std::make_unique<SeenBox>(box, *origin, hidden);
    measurement->index = static_cast<std::uint32_t>(i);
    scan.measurements.push_back(std::move(measurement));
  }
  scan.detectability = [this, stamp = obstacles.stamp](const TrackShape& object) {
    return detectability(object, stamp);
  };
  counters_.add("obstacles", scan.measurements.size());
  tracker_.update(scan, counters_);
  answer(obstacles.stamp);
}

void ObjectStage::take(const Frustums& frustums) {
  Scan scan;
  scan.stamp = frustums.stamp;
  scan.input = "frustums";
  for (std::size_t i = 0; i < frustums.frustums.size(); ++i) {
    auto measurement = std::make_unique<FrustumMeasurement>(frustums.frustums[i]);
    measurement->index = static_cast<std::uint32_t>(i);
    scan.measurements.push_back(std::move(measurement));
  }
  counters_.add("frustums", scan.measurements.size());
  tracker_.update(scan, counters_);
  answerIfSilent(frustums.stamp);
}

void ObjectStage::take(std::size_t radar, const RadarScan& scan) {
  if (!odometry_ || toSeconds(scan.stamp - odometry_->stamp) > params_.max_odometry_age_s) {
    counters_.skip("radar scan", odometry_ ? Reason::kPoseGap : Reason::kNoPoseYet);
    return;
  }
  const Outcome<Pose> T_imu_radar = rig_.T_imu(scan.frame);
  if (!T_imu_radar) {
    counters_.skip("radar scan", T_imu_radar.reason());
    return;
  }
  const Pose T_map_radar = odometry_->T_map_imu * *T_imu_radar;
  const Eigen::Vector3d lever_velocity =
      odometry_->velocity_imu_mps + odometry_->angular_velocity_imu_radps.cross(T_imu_radar->translation);
  const Eigen::Vector3d own_mps = odometry_->T_map_imu.rotation * lever_velocity;
  Scan result;
  result.stamp = scan.stamp;
  result.input = params_.radars[radar] + "/scan";
  for (std::size_t i = 0; i < scan.targets.size(); ++i) {
    const RadarTarget& target = scan.targets[i];
    const Eigen::Vector3d target_map = T_map_radar * target.position;
    const double standing_mps = -(target_map - T_map_radar.translation).normalized().dot(own_mps);
    radar_signs_[radar].add(target.radial_velocity_mps, standing_mps);
    std::optional<double> velocity_mps;
    if (const auto sign = radar_signs_[radar].sign())
      velocity_mps = *sign * target.radial_velocity_mps - standing_mps;
    auto measurement = std::make_unique<RadarMeasurement>(target_map, T_map_radar.translation, velocity_mps);
    measurement->index = static_cast<std::uint32_t>(i);
    result.measurements.push_back(std::move(measurement));
  }
  counters_.add("radar targets", result.measurements.size());
  tracker_.update(result, counters_);
  answerIfSilent(scan.stamp);
}

void ObjectStage::answerIfSilent(Stamp stamp) {
  if (answered_ == kBeginOfTime) answered_ = stamp;  // obstacles may still come
  if (toSeconds(stamp - answered_) > params_.max_silence_s) answer(stamp);
}

void ObjectStage::answer(Stamp stamp) {
  answered_ = stamp;
  auto objects = std::make_shared<Objects>(tracker_.report(stamp));
  if (odometry_ && toSeconds(stamp - odometry_->stamp) <= params_.max_odometry_age_s)
    objects->T_map_imu = odometry_->T_map_imu;
  counters_.add("answers");
  counters_.add("objects", objects->objects.size());
  if (on_objects) on_objects(objects);
}

}  // namespace atlas
