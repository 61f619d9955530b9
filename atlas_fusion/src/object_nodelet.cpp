// SPDX-License-Identifier: MIT
// Nodelet: obstacles, frustums and radar targets become objects.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_fusion {

class ObjectNodelet : public atlas_ros::StageNodelet<atlas::ObjectParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::ObjectParams& params) override {
    return atlas::bindObjects(link, params);
  }
};

}  // namespace atlas_fusion

PLUGINLIB_EXPORT_CLASS(atlas_fusion::ObjectNodelet, nodelet::Nodelet)
