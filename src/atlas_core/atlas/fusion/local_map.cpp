// SPDX-License-Identifier: MIT
#include "atlas/fusion/local_map.hpp"

#include <algorithm>
#include <stdexcept>

namespace atlas {
namespace {

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("local_map: " + what + ", got " + std::to_string(value));
}

Stamp stampOf(const Frustums& value) { return value.stamp; }
template <class T>
Stamp stampOf(const std::shared_ptr<const T>& value) {
  return value->stamp;
}

template <class T>
std::optional<Reason> append(std::deque<T>& list, const T& value) {
  if (!list.empty() && stampOf(value) < stampOf(list.back())) return Reason::kOutOfOrder;
  list.push_back(value);
  return std::nullopt;
}

/// The newest at or before the stamp; null when there is none.
template <class T>
const T* newestBefore(const std::deque<T>& list, Stamp stamp) {
  const auto after = std::upper_bound(list.begin(), list.end(), stamp,
                                      [](Stamp s, const T& value) { return s < stampOf(value); });
  return after == list.begin() ? nullptr : &*std::prev(after);
}

MapCloudPtr cutOut(const MapCloudPtr& cloud, const Eigen::Vector2d& place, double radius_m) {
  auto result = std::make_shared<MapCloud>();
  result->stamp = cloud->stamp;
  for (const LidarPoint& p : cloud->points) {
    const double dx = static_cast<double>(p.x) - place.x(), dy = static_cast<double>(p.y) - place.y();
    if (dx * dx + dy * dy <= radius_m * radius_m) result->points.push_back(p);
  }
  return result;
}

}  // namespace

void validate(const LocalMapParams& p) {
  need(p.history_s > 0.0 && p.history_s <= 600.0, "history_s must lie in (0, 600]", p.history_s);
  need(p.radius_m > 0.0, "radius_m must be positive", p.radius_m);
  need(p.period_s >= 0.0, "period_s must not be negative", p.period_s);
  need(p.frustum_window_s >= 0.0, "frustum_window_s must not be negative", p.frustum_window_s);
}

LocalMap::LocalMap(const LocalMapParams& params) : params_(params) { validate(params); }

std::optional<Reason> LocalMap::add(const Odometry& odometry) {
  if (!odometry.T_map_imu.translation.allFinite() || !odometry.T_map_imu.rotation.coeffs().allFinite())
    return Reason::kNotFinite;
  if (!trajectory_.empty() && odometry.stamp <= trajectory_.poses().back().stamp) return Reason::kOutOfOrder;
  trajectory_.push({odometry.stamp, odometry.T_map_imu});
  forget(odometry.stamp);
  return std::nullopt;
}
std::optional<Reason> LocalMap::add(const ObjectsPtr& objects) { return append(objects_, objects); }
std::optional<Reason> LocalMap::add(const MapCloudPtr& cloud) { return append(clouds_, cloud); }
std::optional<Reason> LocalMap::add(const Frustums& frustums) { return append(frustums_, frustums); }
std::optional<Reason> LocalMap::add(const OccupancyMapPtr& grid) { return append(grids_, grid); }

void LocalMap::forget(Stamp newest) {
  const Stamp oldest = newest - fromSeconds(params_.history_s);
  trajectory_.forgetBefore(oldest);
  const auto drop = [oldest](auto& list) {  // the newest of the old ones still answers
    while (list.size() > 1 && stampOf(list[1]) <= oldest) list.pop_front();
  };
  drop(objects_);
  drop(clouds_);
  drop(frustums_);
  drop(grids_);
}

Objects LocalMap::objectsAround(const Eigen::Vector2d& place, double radius_m, Stamp stamp) const {
  Objects result;
  const ObjectsPtr* objects = newestBefore(objects_, stamp);
  if (objects == nullptr) return result;
  result.stamp = (*objects)->stamp;
  result.T_map_imu = (*objects)->T_map_imu;
  for (const Object& object : (*objects)->objects) {
    if ((object.position.head<2>() - place).norm() <= radius_m) result.objects.push_back(object);
  }
  return result;
}

Outcome<LocalMapView> LocalMap::at(Stamp stamp, double radius_m) const {
  const Outcome<Pose> pose = trajectory_.at(stamp);
  if (!pose) return pose.reason();
  LocalMapView view;
  view.stamp = stamp;
  view.T_map_imu = *pose;
  view.radius_m = radius_m;
  const Eigen::Vector2d place = pose->translation.head<2>();
  view.objects = objectsAround(place, radius_m, stamp);
  if (const MapCloudPtr* cloud = newestBefore(clouds_, stamp)) view.cloud = cutOut(*cloud, place, radius_m);
  if (const OccupancyMapPtr* grid = newestBefore(grids_, stamp)) view.grid = *grid;
  for (const Frustums& frustums : frustums_) {
    if (frustums.stamp > stamp || toSeconds(stamp - frustums.stamp) > params_.frustum_window_s) continue;
    Frustums near = frustums;
    near.frustums.clear();
    for (const Frustum& frustum : frustums.frustums) {
      if ((frustum.position.head<2>() - place).norm() <= radius_m) near.frustums.push_back(frustum);
    }
    view.frustums.push_back(std::move(near));
  }
  return view;
}

Outcome<LocalMapView> LocalMap::newest(double radius_m) const {
  if (trajectory_.empty()) return Reason::kNoPoseYet;
  return at(trajectory_.poses().back().stamp, radius_m);
}

LocalMapStage::LocalMapStage(const LocalMapParams& params)
    : Stage("local_map", {"odometry", "objects", "cloud", "frustums", "grid"}),
      map_(params),
      period_(fromSeconds(params.period_s)) {}

template <class T>
void LocalMapStage::store(std::size_t input, Stamp stamp, const T& value) {
  enqueue(input, stamp, [this, input, stamp, value] {
    emitBefore(stamp);
    if (const auto refused = map_.add(value)) counters_.skip(inputName(input), *refused);
  });
}
void LocalMapStage::push(const Odometry& odometry) { store(kOdometry, odometry.stamp, odometry); }
void LocalMapStage::push(const ObjectsPtr& objects) { store(kObjects, objects->stamp, objects); }
void LocalMapStage::push(const MapCloudPtr& cloud) { store(kCloud, cloud->stamp, cloud); }
void LocalMapStage::push(const Frustums& frustums) { store(kFrustums, frustums.stamp, frustums); }
void LocalMapStage::push(const OccupancyMapPtr& grid) { store(kGrid, grid->stamp, grid); }

void LocalMapStage::emitBefore(Stamp stamp) {
  if (period_ <= 0) return;
  if (next_ == kBeginOfTime) next_ = stamp + period_;
  if (stamp <= next_) return;
  const Outcome<LocalMapView> view =
      map_.newest(map_.params().radius_m);  // everything before `stamp` is there
  if (view) {
    counters_.add("maps");
    if (on_map) on_map(*view);
  } else {
    counters_.skip("map", view.reason());
  }
  next_ += period_ * ((stamp - next_) / period_ + 1);
}

}  // namespace atlas
