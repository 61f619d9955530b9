// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>

#include "atlas_ros/conversions.hpp"
#include "atlas_ros/point_cloud.hpp"

namespace atlas_ros {
namespace {

constexpr const char* kMapFrame = "map";
constexpr const char* kBaseFrame = "base_link";

}  // namespace

nav_msgs::Odometry toMsg(const atlas::Odometry& odometry) {
  nav_msgs::Odometry msg;
  msg.header.stamp = toTime(odometry.stamp);
  msg.header.frame_id = kMapFrame;
  msg.child_frame_id = kBaseFrame;
  msg.pose.pose = toMsg(odometry.T_map_imu);
  msg.twist.twist.linear = vector3(odometry.velocity_imu_mps);
  msg.twist.twist.angular = vector3(odometry.angular_velocity_imu_radps);
  std::copy(odometry.pose_covariance.begin(), odometry.pose_covariance.end(), msg.pose.covariance.begin());
  std::copy(odometry.twist_covariance.begin(), odometry.twist_covariance.end(), msg.twist.covariance.begin());
  return msg;
}

atlas::Outcome<atlas::Odometry> fromMsg(const nav_msgs::Odometry& msg) {
  const auto pose = fromMsg(msg.pose.pose);
  if (!pose) return pose.reason();
  atlas::Odometry odometry;
  odometry.stamp = fromTime(msg.header.stamp);
  odometry.T_map_imu = *pose;
  odometry.velocity_imu_mps = fromXyz(msg.twist.twist.linear);
  odometry.angular_velocity_imu_radps = fromXyz(msg.twist.twist.angular);
  if (!odometry.velocity_imu_mps.allFinite() || !odometry.angular_velocity_imu_radps.allFinite()) {
    return atlas::Reason::kNotFinite;
  }
  std::copy(msg.pose.covariance.begin(), msg.pose.covariance.end(), odometry.pose_covariance.begin());
  std::copy(msg.twist.covariance.begin(), msg.twist.covariance.end(), odometry.twist_covariance.begin());
  return odometry;
}

atlas_msgs::SensorStatus toMsg(const atlas::SensorStatus& status) {
  atlas_msgs::SensorStatus msg;
  msg.header.stamp = toTime(status.stamp);
  msg.sensor = status.sensor;
  msg.score = status.score;
  for (const atlas::SensorAnomaly& a : status.anomalies) {
    atlas_msgs::SensorAnomaly anomaly;
    anomaly.name = a.name;
    anomaly.value = a.value;
    anomaly.threshold = a.threshold;
    anomaly.unit = a.unit;
    anomaly.since = toTime(a.since);
    msg.anomalies.push_back(anomaly);
  }
  return msg;
}

atlas::SensorStatus fromMsg(const atlas_msgs::SensorStatus& msg) {
  atlas::SensorStatus status{fromTime(msg.header.stamp), msg.sensor, msg.score, {}};
  for (const atlas_msgs::SensorAnomaly& a : msg.anomalies)
    status.anomalies.push_back({a.name, a.value, a.threshold, a.unit, fromTime(a.since)});
  return status;
}

atlas_msgs::Origin toMsg(const atlas::Origin& origin) {
  atlas_msgs::Origin msg;
  msg.topic = origin.topic;
  msg.index_known = origin.index.has_value();
  msg.index = origin.index.value_or(0);
  msg.item_known = origin.item.has_value();
  msg.item = origin.item.value_or(0);
  msg.stamp = toTime(origin.stamp);
  return msg;
}

atlas::Origin fromMsg(const atlas_msgs::Origin& msg) {
  atlas::Origin origin{msg.topic, fromTime(msg.stamp), {}, {}};
  if (msg.index_known) origin.index = msg.index;
  if (msg.item_known) origin.item = msg.item;
  return origin;
}

atlas_msgs::ProductOrigins toMsg(const atlas::ProductOrigins& product) {
  atlas_msgs::ProductOrigins msg;
  msg.header.stamp = toTime(product.stamp);
  msg.product = product.product;
  msg.index = product.index;
  for (const atlas::Origin& origin : product.origins) msg.origins.push_back(toMsg(origin));
  return msg;
}

atlas::ProductOrigins fromMsg(const atlas_msgs::ProductOrigins& msg) {
  atlas::ProductOrigins product{msg.product, msg.index, fromTime(msg.header.stamp), {}};
  for (const atlas_msgs::Origin& origin : msg.origins) product.origins.push_back(fromMsg(origin));
  return product;
}

sensor_msgs::NavSatFix toMsg(const atlas::Anchor& anchor) {
  sensor_msgs::NavSatFix msg;
  msg.header.stamp = toTime(anchor.stamp);
  msg.header.frame_id = kMapFrame;
  msg.status.status = sensor_msgs::NavSatStatus::STATUS_FIX;
  msg.status.service = sensor_msgs::NavSatStatus::SERVICE_GPS;
  msg.latitude = anchor.position.latitude_deg;
  msg.longitude = anchor.position.longitude_deg;
  msg.altitude = anchor.position.altitude_m;
  msg.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_KNOWN;  // exact by definition: zeros
  return msg;
}
atlas::Anchor anchorFromMsg(const sensor_msgs::NavSatFix& msg) {
  return {fromTime(msg.header.stamp), {msg.latitude, msg.longitude, msg.altitude}};
}

atlas_msgs::PointBatches toMsg(const atlas::BatchedSweep& batched) {
  atlas_msgs::PointBatches msg;
  msg.header.stamp = toTime(batched.stamp);
  msg.header.frame_id = batched.frame;
  msg.points = toMsg(*batched.sweep);
  msg.batches.reserve(batched.batches.size());
  for (const atlas::Batch& batch : batched.batches) {
    atlas_msgs::PointBatch m;
    m.first = batch.first;
    m.count = batch.count;
    m.stamp_ns = batch.stamp;
    m.T_map_lidar = toMsg(batch.T_map_lidar);
    msg.batches.push_back(m);
  }
  msg.batch_of_point = batched.batch_of_point;
  msg.T_map_lidar = toMsg(batched.T_map_lidar);
  return msg;
}

atlas::Outcome<atlas::BatchedSweepPtr> fromMsg(const atlas_msgs::PointBatches& msg) {
  const auto sweep = fromMsg(msg.points);
  if (!sweep) return sweep.reason();
  auto batched = std::make_shared<atlas::BatchedSweep>();
  batched->stamp = fromTime(msg.header.stamp);
  batched->frame = msg.header.frame_id;
  batched->sweep = *sweep;
  const std::size_t points = batched->sweep->points.size();
  const bool ordered = msg.batch_of_point.empty();
  if (!ordered && msg.batch_of_point.size() != points) return atlas::Reason::kBadLayout;
  for (const std::uint16_t batch : msg.batch_of_point) {
    if (batch >= msg.batches.size()) return atlas::Reason::kBadLayout;
  }
  batched->batches.reserve(msg.batches.size());
  for (const atlas_msgs::PointBatch& m : msg.batches) {
    if (ordered && static_cast<std::size_t>(m.first) + m.count > points) return atlas::Reason::kBadLayout;
    const auto pose = fromMsg(m.T_map_lidar);
    if (!pose) return pose.reason();
    batched->batches.push_back({m.first, m.count, m.stamp_ns, *pose});
  }
  batched->batch_of_point = msg.batch_of_point;
  const auto pose = fromMsg(msg.T_map_lidar);
  if (!pose) return pose.reason();
  batched->T_map_lidar = *pose;
  return atlas::BatchedSweepPtr(batched);
}

atlas_msgs::ObstacleArray toMsg(const atlas::Obstacles& obstacles) {
  atlas_msgs::ObstacleArray msg;
  msg.header.stamp = toTime(obstacles.stamp);
  msg.header.frame_id = kMapFrame;
  for (const atlas::Obstacle& obstacle : obstacles.obstacles) {
    atlas_msgs::Obstacle m;
    m.center = point(obstacle.center);
    m.yaw = obstacle.yaw_rad;
    m.size = vector3(obstacle.size);
    m.points = obstacle.points;
    msg.obstacles.push_back(m);
  }
  return msg;
}
atlas::Obstacles fromMsg(const atlas_msgs::ObstacleArray& msg) {
  atlas::Obstacles obstacles;
  obstacles.stamp = fromTime(msg.header.stamp);
  for (const atlas_msgs::Obstacle& m : msg.obstacles) {
    obstacles.obstacles.push_back({fromXyz(m.center), m.yaw, fromXyz(m.size), m.points});
  }
  return obstacles;
}

atlas_msgs::LineArray toMsg(const atlas::Lines& lines) {
  atlas_msgs::LineArray msg;
  msg.header.stamp = toTime(lines.stamp);
  msg.header.frame_id = kMapFrame;
  msg.lidar = lines.frame;
  msg.lines.reserve(lines.lines.size());
  for (const atlas::Line& line : lines.lines) {
    atlas_msgs::Line m;
    m.kind = static_cast<std::uint8_t>(line.kind);
    m.start = point(line.from);
    m.end = point(line.to);
    m.ring = line.ring;
    m.points = line.points;
    m.rms = line.rms_m;
    m.intensity = line.intensity;
    msg.lines.push_back(m);
  }
  return msg;
}
atlas::Outcome<atlas::Lines> fromMsg(const atlas_msgs::LineArray& msg) {
  atlas::Lines lines{fromTime(msg.header.stamp), msg.lidar, {}};
  lines.lines.reserve(msg.lines.size());
  for (const atlas_msgs::Line& m : msg.lines) {
    if (m.kind > atlas_msgs::Line::MARKING) return atlas::Reason::kBadLayout;
    const Eigen::Vector3d from = fromXyz(m.start), to = fromXyz(m.end);
    if (!from.allFinite() || !to.allFinite()) return atlas::Reason::kNotFinite;
    lines.lines.push_back(
        {static_cast<atlas::LineKind>(m.kind), from, to, m.ring, m.points, m.rms, m.intensity});
  }
  return lines;
}

atlas_msgs::FrustumArray toMsg(const atlas::Frustums& frustums) {
  atlas_msgs::FrustumArray msg;
  msg.header.stamp = toTime(frustums.stamp);
  msg.header.frame_id = kMapFrame;
  msg.camera = frustums.camera;
  msg.image_index = frustums.image_index;
  for (const atlas::Frustum& frustum : frustums.frustums) {
    atlas_msgs::Frustum m;
    m.detection_index = frustum.detection_index;
    m.detection = toMsg(frustum.detection);
    m.distance_m = frustum.distance_m;
    m.range_m = frustum.range_m;
    m.depth_sigma_m = frustum.depth_sigma_m;
    m.points = frustum.points;
    m.position = point(frustum.position);
    for (std::size_t i = 0; i < frustum.corners.size(); ++i) m.corners[i] = point(frustum.corners[i]);
    msg.frustums.push_back(m);
  }
  return msg;
}
atlas::Frustums fromMsg(const atlas_msgs::FrustumArray& msg) {
  atlas::Frustums frustums;
  frustums.stamp = fromTime(msg.header.stamp);
  frustums.camera = msg.camera;
  frustums.image_index = msg.image_index;
  for (const atlas_msgs::Frustum& m : msg.frustums) {
    atlas::Frustum frustum;
    frustum.detection_index = m.detection_index;
    frustum.detection = fromMsg(m.detection);
    frustum.distance_m = m.distance_m;
    frustum.range_m = m.range_m;
    frustum.depth_sigma_m = m.depth_sigma_m;
    frustum.points = m.points;
    frustum.position = fromXyz(m.position);
    for (std::size_t i = 0; i < frustum.corners.size(); ++i) frustum.corners[i] = fromXyz(m.corners[i]);
    frustums.frustums.push_back(frustum);
  }
  return frustums;
}

atlas_msgs::ProjectedDetections toMsg(const atlas::ProjectedDetections& projected) {
  atlas_msgs::ProjectedDetections msg;
  msg.header.stamp = toTime(projected.detections.stamp);
  msg.header.frame_id = projected.detections.frame;
  msg.image_index = projected.detections.image_index;
  msg.selected = projected.selected;
  for (const atlas::Stamp stamp : projected.source_stamps) msg.source_stamps.push_back(toTime(stamp));
  for (const atlas::Detection2d& box : projected.detections.boxes) msg.detections.push_back(toMsg(box));
  msg.source_index = projected.source_index;
  return msg;
}
atlas::ProjectedDetections fromMsg(const atlas_msgs::ProjectedDetections& msg) {
  atlas::ProjectedDetections projected;
  projected.detections.stamp = fromTime(msg.header.stamp);
  projected.detections.frame = msg.header.frame_id;
  projected.detections.image_index = msg.image_index;
  projected.selected = msg.selected != 0;
  for (const ros::Time& time : msg.source_stamps) projected.source_stamps.push_back(fromTime(time));
  for (const atlas_msgs::Detection2d& m : msg.detections) projected.detections.boxes.push_back(fromMsg(m));
  projected.source_index = msg.source_index;
  return projected;
}

}  // namespace atlas_ros
