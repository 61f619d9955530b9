// SPDX-License-Identifier: MIT
// Nodelet: ground and oriented obstacle boxes of the lidars.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_lidar {

class ObstacleNodelet : public atlas_ros::StageNodelet<atlas::ObstacleParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::ObstacleParams& params) override {
    return atlas::bindObstacles(link, params);
  }
};

}  // namespace atlas_lidar

PLUGINLIB_EXPORT_CLASS(atlas_lidar::ObstacleNodelet, nodelet::Nodelet)
