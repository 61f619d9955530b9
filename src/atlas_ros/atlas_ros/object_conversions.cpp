// SPDX-License-Identifier: MIT
#include "atlas_ros/object_conversions.hpp"

#include <algorithm>
#include <cmath>

#include "atlas_ros/grid_conversions.hpp"
#include "atlas_ros/point_cloud.hpp"

namespace atlas_ros {
namespace {

constexpr const char* kMapFrame = "map";

atlas_msgs::Object toMsg(const atlas::Object& o) {
  atlas_msgs::Object msg;
  msg.id = o.id;
  msg.class_id = o.class_id;
  msg.class_probability = o.class_probability;
  msg.class_probabilities = o.class_probabilities;
  msg.existence = o.existence;
  msg.position = point(o.position);
  msg.yaw = o.yaw_rad;
  msg.heading_known = o.heading_known;
  msg.size = vector3(o.size);
  msg.velocity = vector3(o.velocity_mps);
  msg.yaw_rate = o.yaw_rate_radps;
  std::copy(o.covariance.begin(), o.covariance.end(), msg.covariance.begin());
  msg.z_variance = o.z_variance_m2;
  msg.yaw_variance = o.yaw_variance_rad2;
  msg.static_probability = o.static_probability;
  msg.is_static = o.is_static;
  msg.age = o.age_s;
  msg.unseen = o.unseen_s;
  msg.detectability = o.detectability;
  msg.score = o.score;
  for (const atlas::Origin& source : o.sources) msg.sources.push_back(atlas_ros::toMsg(source));
  for (const atlas::ObjectPast& past : o.history) {
    msg.history.emplace_back();
    msg.history.back().stamp = toTime(past.stamp);
    msg.history.back().position = point(past.position);
    msg.history.back().velocity = vector3(past.velocity_mps);
    msg.history.back().yaw = past.yaw_rad;
  }
  return msg;
}

atlas::Outcome<atlas::Object> fromMsg(const atlas_msgs::Object& msg) {
  atlas::Object o;
  o.id = msg.id;
  o.class_id = msg.class_id;
  o.class_probability = msg.class_probability;
  o.class_probabilities = msg.class_probabilities;
  o.existence = msg.existence;
  o.position = fromXyz(msg.position);
  o.yaw_rad = msg.yaw;
  o.heading_known = msg.heading_known != 0;
  o.size = fromXyz(msg.size);
  o.velocity_mps = fromXyz(msg.velocity);
  o.yaw_rate_radps = msg.yaw_rate;
  if (!o.position.allFinite() || !o.size.allFinite() || !o.velocity_mps.allFinite() ||
      !std::isfinite(o.yaw_rad))
    return atlas::Reason::kNotFinite;
  std::copy(msg.covariance.begin(), msg.covariance.end(), o.covariance.begin());
  o.z_variance_m2 = msg.z_variance;
  o.yaw_variance_rad2 = msg.yaw_variance;
  o.static_probability = msg.static_probability;
  o.is_static = msg.is_static != 0;
  o.age_s = msg.age;
  o.unseen_s = msg.unseen;
  o.detectability = msg.detectability;
  o.score = msg.score;
  for (const atlas_msgs::Origin& source : msg.sources) o.sources.push_back(atlas_ros::fromMsg(source));
  for (const auto& past : msg.history)
    o.history.push_back({fromTime(past.stamp), fromXyz(past.position), fromXyz(past.velocity), past.yaw});
  return o;
}

}  // namespace

atlas_msgs::ObjectArray toMsg(const atlas::Objects& objects) {
  atlas_msgs::ObjectArray msg;
  msg.header.stamp = toTime(objects.stamp);
  msg.header.frame_id = kMapFrame;
  msg.has_pose = objects.T_map_imu.has_value();
  msg.T_map_imu = toMsg(objects.T_map_imu.value_or(atlas::Pose{}));
  for (const atlas::Object& object : objects.objects) msg.objects.push_back(toMsg(object));
  return msg;
}

atlas::Outcome<atlas::ObjectsPtr> fromMsg(const atlas_msgs::ObjectArray& msg) {
  auto objects = std::make_shared<atlas::Objects>();
  objects->stamp = fromTime(msg.header.stamp);
  if (msg.has_pose != 0) {
    const auto pose = fromMsg(msg.T_map_imu);
    if (!pose) return pose.reason();
    objects->T_map_imu = *pose;
  }
  for (const atlas_msgs::Object& m : msg.objects) {
    const auto object = fromMsg(m);
    if (!object) return object.reason();
    objects->objects.push_back(*object);
  }
  return atlas::ObjectsPtr(objects);
}

atlas_msgs::LocalMap toMsg(const atlas::LocalMapView& view) {
  atlas_msgs::LocalMap msg;
  msg.header.stamp = toTime(view.stamp);
  msg.header.frame_id = kMapFrame;
  msg.T_map_imu = toMsg(view.T_map_imu);
  msg.radius = view.radius_m;
  msg.objects = toMsg(view.objects);
  if (view.cloud) msg.cloud = toCloud(view.cloud->points, view.cloud->stamp, kMapFrame);
  for (const atlas::Frustums& frustums : view.frustums) msg.frustums.push_back(toMsg(frustums));
  if (view.grid) msg.grid = toMsg(*view.grid);
  return msg;
}

}  // namespace atlas_ros
