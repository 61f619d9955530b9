// SPDX-License-Identifier: MIT
// Nodelet: GNSS and IMU become odometry at IMU rate, tf, a path and the anchor of map; beside them what
// outside nodes and people want to know: fused fix, bias of the IMU, status with innovation statistics.
#include <tf2_ros/transform_broadcaster.h>

#include <optional>
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"
#include "status_messages.hpp"

namespace atlas_localization {

class LocalizationNodelet : public atlas_ros::StageNodelet<atlas::LocalizationParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::LocalizationParams& params) override {
    const atlas::StageFactory factory = atlas::bindLocalization(link, params);
    using atlas_ros::kKeepAll;
    ros::NodeHandle& handle = getNodeHandle();
    path_publisher_ = handle.advertise<nav_msgs::Path>("trajectory", kKeepAll, true);
    anchor_publisher_ = handle.advertise<sensor_msgs::NavSatFix>("geographic", kKeepAll, true);
    fix_publisher_ = handle.advertise<sensor_msgs::NavSatFix>("fused_fix", kKeepAll);
    bias_publisher_ = handle.advertise<atlas_msgs::ImuBias>("imu_bias", kKeepAll);
    status_publisher_ = handle.advertise<atlas_msgs::LocalizationStatus>("localization_status", kKeepAll);
    link.on_end = [this] {
      if (path_.hasMore()) path_publisher_.publish(path_.message());
    };
    return [this, factory] {
      path_ = {};
      map_.reset();
      auto stage = factory();
      auto& localization = static_cast<atlas::LocalizationStage&>(*stage);
      localization.on_odometry = [this, emit = localization.on_odometry](const atlas::Odometry& odometry) {
        emit(odometry);
        show(odometry);
      };
      localization.on_anchor = [this, emit = localization.on_anchor](const atlas::Anchor& anchor) {
        emit(anchor);
        map_.emplace(anchor.position);
        anchor_publisher_.publish(atlas_ros::toMsg(anchor));
      };
      localization.on_status = [this](const atlas::LocalizationStatus& status) {
        status_publisher_.publish(toMsg(status));
        if (status.bias) bias_publisher_.publish(toMsg(*status.bias, status.stamp));
      };
      return stage;
    };
  }

  void show(const atlas::Odometry& odometry) {
    broadcaster_.sendTransform(transformsOf(odometry));
    if (map_ && fix_publisher_.getNumSubscribers() > 0) fix_publisher_.publish(fusedFix(odometry, *map_));
    if (path_.extend(odometry)) path_publisher_.publish(path_.message());
  }

  ros::Publisher path_publisher_, anchor_publisher_, fix_publisher_, bias_publisher_, status_publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  GrowingPath path_;
  std::optional<atlas::LocalEnu> map_;
};

}  // namespace atlas_localization

PLUGINLIB_EXPORT_CLASS(atlas_localization::LocalizationNodelet, nodelet::Nodelet)
