// SPDX-License-Identifier: MIT
// Nodelet: lidar layers and stereo grids become an occupancy grid with velocities, objects and collision
// risk.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_fusion {

class OccupancyNodelet : public atlas_ros::StageNodelet<atlas::OccupancyParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::OccupancyParams& params) override {
    return atlas::bindOccupancy(link, params);
  }
};

}  // namespace atlas_fusion

PLUGINLIB_EXPORT_CLASS(atlas_fusion::OccupancyNodelet, nodelet::Nodelet)
