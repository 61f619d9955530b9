// SPDX-License-Identifier: MIT
// Nodelet: ground and oriented obstacle boxes of the lidars.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_lidar {

class ObstacleNodelet : public atlas_ros::StageNodelet<atlas::ObstacleParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::ObstacleParams& params) override {
    const atlas::StageFactory factory = atlas::bindObstacles(link, params);
    ground_ = getNodeHandle().advertise<sensor_msgs::PointCloud2>("ground", atlas_ros::kKeepAll);
    return [this, factory] {
      auto stage = factory();
      auto& obstacles = static_cast<atlas::ObstacleStage&>(*stage);
      obstacles.on_obstacles = [this, emit = obstacles.on_obstacles](const atlas::Obstacles& found) {
        emit(found);
        publishGround(found);
      };
      return stage;
    };
  }

  /// Not an input of any stage: only made when somebody listens.
  void publishGround(const atlas::Obstacles& found) {
    if (found.ground && ground_.getNumSubscribers() > 0)
      ground_.publish(atlas_ros::toCloud(found.ground->points, found.ground->stamp, "map"));
  }

  ros::Publisher ground_;
};

}  // namespace atlas_lidar

PLUGINLIB_EXPORT_CLASS(atlas_lidar::ObstacleNodelet, nodelet::Nodelet)
