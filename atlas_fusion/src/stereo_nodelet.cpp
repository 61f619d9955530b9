// SPDX-License-Identifier: MIT
// Nodelet: images of two cameras side by side become disparities and the ground seen from above.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_fusion {

class StereoNodelet : public atlas_ros::StageNodelet<atlas::StereoStageParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::StereoStageParams& params) override {
    return atlas::bindStereo(link, params);
  }
};

}  // namespace atlas_fusion

PLUGINLIB_EXPORT_CLASS(atlas_fusion::StereoNodelet, nodelet::Nodelet)
