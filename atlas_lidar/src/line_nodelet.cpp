// SPDX-License-Identifier: MIT
// Nodelet: straight lines along the traces of single lasers, and where these cross road markings.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_lidar {

class LineNodelet : public atlas_ros::StageNodelet<atlas::LineParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::LineParams& params) override {
    return atlas::bindLines(link, params);
  }
};

}  // namespace atlas_lidar

PLUGINLIB_EXPORT_CLASS(atlas_lidar::LineNodelet, nodelet::Nodelet)
