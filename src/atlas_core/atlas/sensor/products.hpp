// SPDX-License-Identifier: MIT
// What the stages make of the sensor data and hand to each other. Stamps are those of the data that a product
// answers.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/made_once.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// Pose and velocity of base_link (= imu) with covariances, as nav_msgs/Odometry (REP-105).
struct Odometry {
  Stamp stamp = 0;
  Pose T_map_imu;
  Eigen::Vector3d velocity_imu_mps = Eigen::Vector3d::Zero();  ///< expressed in the imu frame
  Eigen::Vector3d angular_velocity_imu_radps = Eigen::Vector3d::Zero();
  /// Row-major 6x6 of (x, y, z, rotation about fixed map axes x, y, z): m^2, rad^2.
  std::array<double, 36> pose_covariance{};
  /// Row-major 6x6 of (v, omega) in the imu frame.
  std::array<double, 36> twist_covariance{};
};

/// Origin of `map`.
struct Anchor {
  Stamp stamp = 0;
  Geodetic position;
};

/// A sweep cut into batches of consecutive points, each with the pose of its time: the lazy transform of the
/// paper (section IV-B). A point is transformed when somebody asks for it: p_map = T_map_lidar(batch) *
/// p_lidar.
struct Batch {
  std::uint32_t first = 0;  ///< range of points; unused where BatchedSweep::batch_of_point is given
  std::uint32_t count = 0;
  Stamp stamp = 0;  ///< time of the pose
  Pose T_map_lidar;
};
struct CompactSweep;  // camera/compact_sweep.hpp
struct BatchedSweep {
  Stamp stamp = 0;
  std::string frame;           ///< lidar frame
  SweepPtr sweep;              ///< points in the lidar frame, NaN kept
  std::vector<Batch> batches;  ///< in time order, covering all points; empty when there was no pose
  /// Batch of each point, for sweeps whose points are not stored in order of time (laser by laser); else
  /// empty.
  std::vector<std::uint16_t> batch_of_point;
  Pose T_map_lidar;                ///< at the sweep's stamp; meaningful when batches is not empty
  MadeOnce<CompactSweep> compact;  ///< of compactedOnce()
};

/// Calls visit(point index, batch) for every point in the order of the sweep; nothing when there are no
/// batches.
template <class Visit>
void forEachPoint(const BatchedSweep& batched, Visit&& visit) {
  if (batched.batches.empty()) return;
  if (!batched.batch_of_point.empty()) {
    for (std::size_t i = 0; i < batched.batch_of_point.size(); ++i)
      visit(i, batched.batches[batched.batch_of_point[i]]);
    return;
  }
  for (const Batch& batch : batched.batches) {
    for (std::size_t i = batch.first; i < static_cast<std::size_t>(batch.first) + batch.count; ++i)
      visit(i, batch);
  }
}
using BatchedSweepPtr = std::shared_ptr<const BatchedSweep>;

/// Points in `map`.
struct MapCloud {
  Stamp stamp = 0;
  std::vector<LidarPoint> points;  ///< x, y, z in map; time relative to stamp
};
using MapCloudPtr = std::shared_ptr<const MapCloud>;

/// Oriented box of one lidar obstacle in `map`; yaw about z.
struct Obstacle {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m, map
  double yaw_rad = 0;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< length (along yaw), width, height, m
  std::uint32_t points = 0;
};
struct Obstacles {
  Stamp stamp = 0;
  std::vector<Obstacle> obstacles;
  MapCloudPtr ground;  ///< points taken as ground; may be null
};

/// A camera detection with a distance: the piece of its viewing pyramid between the near and the far plane.
struct Frustum {
  std::uint32_t detection_index = 0;  ///< index in the Detections of the image
  Detection2d detection;
  double distance_m = 0;     ///< z-depth of the front of the object along the optical axis
  double range_m = 0;        ///< Euclidean distance of `position` from the optical centre
  double depth_sigma_m = 0;  ///< standard deviation of distance_m, estimated from the points used
  std::uint32_t points = 0;  ///< lidar points used
  Eigen::Vector3d position =
      Eigen::Vector3d::Zero();  ///< map: on the bearing of the box centre at distance_m
  /// map: near plane (TL, TR, BR, BL) then far plane (same order).
  std::array<Eigen::Vector3d, 8> corners{};
};
struct Frustums {
  Stamp stamp = 0;     ///< of the image
  std::string camera;  ///< e.g. "camera_left_front"
  std::uint32_t image_index = 0;
  std::vector<Frustum> frustums;
};

/// Detections moved into the thermal image that is nearest in time to the RGB image they were found in.
struct ProjectedDetections {
  Detections detections;  ///< stamp, frame and index of the thermal image; boxes clipped to it
  bool selected = false;  ///< some RGB image chose this thermal frame (false: an empty answer only)
  std::vector<Stamp> source_stamps;  ///< RGB images that chose it
  /// Per box: index of the frustum in its source; the largest number for an object missed there, but seen in
  /// the images before and after.
  std::vector<std::uint32_t> source_index;
};

/// Dense or sparse z-depth registered to an image (REP-118): 32FC1, m, NaN where unknown.
struct DepthImage {
  Stamp stamp = 0;
  std::string camera;
  std::uint32_t image_index = 0;
  CameraInfo camera_info;
  cv::Mat depth;  ///< CV_32FC1
};
using DepthImagePtr = std::shared_ptr<const DepthImage>;

/// A message that something was made from.
struct Origin {
  std::string topic;
  Stamp stamp = 0;
  std::optional<std::uint32_t> index;  ///< 0-based number of the message in its topic, where that is known
  std::optional<std::uint32_t> item;   ///< index of the one thing in the message, where it was one
};
/// What one product was made from; how its origins came about is told by theirs.
struct ProductOrigins {
  std::string product;      ///< its topic
  std::uint32_t index = 0;  ///< 0-based number in its topic
  Stamp stamp = 0;
  std::vector<Origin> origins;
};

/// Something that a sensor does and a sound one does not.
struct SensorAnomaly {
  std::string name;
  double value = 0, threshold = 0;  ///< of the newest measurement beyond the threshold
  std::string unit;                 ///< of both
  Stamp since = 0;
};
/// How far a sensor can be believed: once a second of event time, and when its anomalies change.
struct SensorStatus {
  Stamp stamp = 0;
  std::string sensor;  ///< e.g. "lidar_left"
  double score = 1;    ///< 0..1
  std::vector<SensorAnomaly> anomalies;
};

}  // namespace atlas
