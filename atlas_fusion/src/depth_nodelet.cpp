// SPDX-License-Identifier: MIT
// Nodelet: a depth image (REP-118) for every frame of the chosen cameras.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_fusion {

class DepthNodelet : public atlas_ros::StageNodelet<atlas::DepthParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::DepthParams& params) override {
    const atlas::StageFactory factory = atlas::bindDepth(link, params);
    for (const std::string& camera : params.cameras) {
      infos_.push_back(getNodeHandle().advertise<sensor_msgs::CameraInfo>(camera + "/depth/camera_info",
                                                                          atlas_ros::kKeepAll));
    }
    return [this, factory] {
      auto stage = factory();
      auto& depth = static_cast<atlas::DepthStage&>(*stage);
      depth.on_depth = [this, emit = depth.on_depth](std::size_t camera, const atlas::DepthImagePtr& image) {
        infos_[camera].publish(atlas_ros::toMsg(image->camera_info));
        emit(camera, image);
      };
      return stage;
    };
  }

  std::vector<ros::Publisher> infos_;
};

}  // namespace atlas_fusion

PLUGINLIB_EXPORT_CLASS(atlas_fusion::DepthNodelet, nodelet::Nodelet)
