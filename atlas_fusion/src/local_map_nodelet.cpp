// SPDX-License-Identifier: MIT
// Nodelet: the local map as a topic at a chosen rate, and as a service that answers for any time of its
// history.
#include <atlas_msgs/GetLocalMap.h>

#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/object_conversions.hpp"
#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_fusion {

class LocalMapNodelet : public atlas_ros::StageNodelet<atlas::LocalMapParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::LocalMapParams& params) override {
    const atlas::StageFactory factory = atlas::bindLocalMap(link, params);
    radius_m_ = params.radius_m;
    link_of_stage_ = &link;
    service_ = getNodeHandle().advertiseService("get_local_map", &LocalMapNodelet::answer, this);
    return factory;
  }

  bool answer(atlas_msgs::GetLocalMap::Request& request, atlas_msgs::GetLocalMap::Response& response) {
    const auto* stage = static_cast<const atlas::LocalMapStage*>(link_of_stage_->stage());
    if (stage == nullptr) {
      response.reason = "no run has begun";
      return true;
    }
    const double radius_m = request.radius > 0.0 ? request.radius : radius_m_;
    const atlas::Stamp stamp = atlas_ros::fromTime(request.stamp);
    const auto view = stamp == 0 ? stage->map().newest(radius_m) : stage->map().at(stamp, radius_m);
    response.found = static_cast<bool>(view);
    if (view) {
      response.map = atlas_ros::toMsg(*view);
    } else {
      response.reason = atlas::toString(view.reason());
    }
    return true;
  }

  double radius_m_ = 0.0;
  const atlas_ros::StageLink* link_of_stage_ = nullptr;
  ros::ServiceServer service_;
};

}  // namespace atlas_fusion

PLUGINLIB_EXPORT_CLASS(atlas_fusion::LocalMapNodelet, nodelet::Nodelet)
