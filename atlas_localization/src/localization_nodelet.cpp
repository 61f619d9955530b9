// SPDX-License-Identifier: MIT
// Nodelet: GNSS and IMU become odometry at IMU rate, tf, a path and the anchor of map.
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <tf2_ros/transform_broadcaster.h>

#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_localization {

class LocalizationNodelet : public atlas_ros::StageNodelet<atlas::LocalizationParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::LocalizationParams& params) override {
    path_publisher_ = getNodeHandle().advertise<nav_msgs::Path>("trajectory", atlas_ros::kKeepAll, true);
    anchor_publisher_ =
        getNodeHandle().advertise<sensor_msgs::NavSatFix>("geographic", atlas_ros::kKeepAll, true);
    const atlas::StageFactory factory = atlas::bindLocalization(link, params);
    return [this, factory] {
      path_ = {};
      auto stage = factory();
      auto& localization = static_cast<atlas::LocalizationStage&>(*stage);
      localization.on_odometry = [this, emit = localization.on_odometry](const atlas::Odometry& odometry) {
        emit(odometry);
        show(odometry);
      };
      localization.on_anchor = [this, emit = localization.on_anchor](const atlas::Anchor& anchor) {
        emit(anchor);
        anchor_publisher_.publish(atlas_ros::toMsg(anchor));
      };
      return stage;
    };
  }

  /// For outside nodes: tf map -> odom -> base_link (map and odom coincide: the filter is global) and a
  /// thinned path.
  void show(const atlas::Odometry& odometry) {
    geometry_msgs::TransformStamped base;
    base.header.stamp = atlas_ros::toTime(odometry.stamp);
    base.header.frame_id = "odom";
    base.child_frame_id = "base_link";
    const geometry_msgs::Pose pose = atlas_ros::toMsg(odometry.T_map_imu);
    base.transform.translation.x = pose.position.x;
    base.transform.translation.y = pose.position.y;
    base.transform.translation.z = pose.position.z;
    base.transform.rotation = pose.orientation;
    geometry_msgs::TransformStamped odom;
    odom.header.stamp = base.header.stamp;
    odom.header.frame_id = "map";
    odom.child_frame_id = "odom";
    odom.transform.rotation.w = 1.0;
    broadcaster_.sendTransform({odom, base});
    extendPath(base.header.stamp, pose, odometry.T_map_imu.translation);
  }

  void extendPath(const ros::Time& stamp, const geometry_msgs::Pose& pose, const Eigen::Vector3d& position) {
    constexpr double kStep = 0.5;              // m between points of the path
    constexpr std::size_t kMostPoses = 20000;  // then every second one goes: constant memory
    if (!path_.poses.empty() && (position - last_position_).norm() < kStep) return;
    last_position_ = position;
    geometry_msgs::PoseStamped stamped;
    stamped.header.stamp = stamp;
    stamped.header.frame_id = "map";
    stamped.pose = pose;
    path_.header = stamped.header;
    path_.poses.push_back(stamped);
    if (path_.poses.size() > kMostPoses) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < path_.poses.size(); i += 2) path_.poses[kept++] = path_.poses[i];
      path_.poses.resize(kept);
    }
    path_publisher_.publish(path_);
  }

  ros::Publisher path_publisher_, anchor_publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  nav_msgs::Path path_;
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();
};

}  // namespace atlas_localization

PLUGINLIB_EXPORT_CLASS(atlas_localization::LocalizationNodelet, nodelet::Nodelet)
