// SPDX-License-Identifier: MIT
// Nodelet: camera detections become frustums with the distance that the lidars measured.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_fusion {

class CameraLidarNodelet : public atlas_ros::StageNodelet<atlas::CameraLidarParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::CameraLidarParams& params) override {
    return atlas::bindCameraLidar(link, params);
  }
};

}  // namespace atlas_fusion

PLUGINLIB_EXPORT_CLASS(atlas_fusion::CameraLidarNodelet, nodelet::Nodelet)
