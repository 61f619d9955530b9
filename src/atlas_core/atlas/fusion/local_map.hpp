// SPDX-License-Identifier: MIT
// The Local Map of the paper (II-C, III-E) as a container: the newest seconds of poses, objects, clouds,
// frustums and occupancy grids, and the question what was around the vehicle at a time. A library for offline
// runs, a topic and a service for others.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "atlas/base/outcome.hpp"
#include "atlas/base/stage.hpp"
#include "atlas/base/trajectory.hpp"
#include "atlas/sensor/object.hpp"
#include "atlas/sensor/occupancy_map.hpp"

namespace atlas {

struct LocalMapParams {
  double history_s = 10.0;        ///< what is older is forgotten
  double radius_m = 60.0;         ///< around the vehicle
  double period_s = 1.0;          ///< of event time between two maps on the topic, 0 = none
  double frustum_window_s = 0.5;  ///< frustums of the images before the time
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const LocalMapParams& params);

/// What was known at a time, around the vehicle's place.
struct LocalMapView {
  Stamp stamp = 0;
  Pose T_map_imu;
  double radius_m = 0;
  Objects objects;                 ///< the newest at or before the stamp
  MapCloudPtr cloud;               ///< points within the radius of the newest cloud; null when there is none
  std::vector<Frustums> frustums;  ///< of the window before the stamp, those within the radius, oldest first
  OccupancyMapPtr grid;            ///< the newest at or before the stamp, whole; null when there is none
};

class LocalMap {
 public:
  explicit LocalMap(const LocalMapParams& params);
  /// Values of a kind must come in order of time; one that does not answers kOutOfOrder and is not stored.
  std::optional<Reason> add(const Odometry& odometry);
  std::optional<Reason> add(const ObjectsPtr& objects);
  std::optional<Reason> add(const MapCloudPtr& cloud);
  std::optional<Reason> add(const Frustums& frustums);
  std::optional<Reason> add(const OccupancyMapPtr& grid);

  /// kNoPoseYet before the history, kPoseNotReached after the newest pose, kPoseGap between.
  [[nodiscard]] Outcome<LocalMapView> at(Stamp stamp, double radius_m) const;
  [[nodiscard]] Outcome<LocalMapView> at(Stamp stamp) const { return at(stamp, params_.radius_m); }
  /// At the newest pose.
  [[nodiscard]] Outcome<LocalMapView> newest(double radius_m) const;
  /// Objects whose middle lies within the radius of a place, in the newest objects at or before the stamp.
  [[nodiscard]] Objects objectsAround(const Eigen::Vector2d& place, double radius_m, Stamp stamp) const;

  [[nodiscard]] const LocalMapParams& params() const { return params_; }

 private:
  void forget(Stamp newest);

  LocalMapParams params_;
  Trajectory trajectory_;
  std::deque<ObjectsPtr> objects_;
  std::deque<MapCloudPtr> clouds_;
  std::deque<Frustums> frustums_;
  std::deque<OccupancyMapPtr> grids_;
};

/// Stage: fills a LocalMap, gives it out at a chosen rate.
class LocalMapStage : public Stage {
 public:
  enum Input : std::size_t { kOdometry, kObjects, kCloud, kFrustums, kGrid };
  explicit LocalMapStage(const LocalMapParams& params);
  void push(const Odometry& odometry);
  void push(const ObjectsPtr& objects);
  void push(const MapCloudPtr& cloud);
  void push(const Frustums& frustums);
  void push(const OccupancyMapPtr& grid);
  /// Every period_s of event time, after everything up to its stamp has come.
  std::function<void(const LocalMapView&)> on_map;
  [[nodiscard]] const LocalMap& map() const { return map_; }

 private:
  template <class T>
  void store(std::size_t input, Stamp stamp, const T& value);
  void emitBefore(Stamp stamp);

  LocalMap map_;
  Duration period_;
  Stamp next_ = kBeginOfTime;  ///< of the next map on the topic
};

}  // namespace atlas
