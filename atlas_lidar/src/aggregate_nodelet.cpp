// SPDX-License-Identifier: MIT
// Nodelet: the aggregated cloud of the last seconds, in map.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_lidar {

class AggregateNodelet : public atlas_ros::StageNodelet<atlas::AggregateParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::AggregateParams& params) override {
    return atlas::bindAggregate(link, params);
  }
};

}  // namespace atlas_lidar

PLUGINLIB_EXPORT_CLASS(atlas_lidar::AggregateNodelet, nodelet::Nodelet)
