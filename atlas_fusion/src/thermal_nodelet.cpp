// SPDX-License-Identifier: MIT
// Nodelet: detections of the RGB cameras projected into the nearest thermal frame.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_fusion {

class ThermalNodelet : public atlas_ros::StageNodelet<atlas::ThermalParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::ThermalParams& params) override {
    return atlas::bindThermal(link, params);
  }
};

}  // namespace atlas_fusion

PLUGINLIB_EXPORT_CLASS(atlas_fusion::ThermalNodelet, nodelet::Nodelet)
