// SPDX-License-Identifier: MIT
// Nodelet: sweeps become batches with one pose each, and clouds as seen from the pose at the sweep's stamp.
#include <pluginlib/class_list_macros.hpp>

#include "atlas/lidar/batched_points.hpp"
#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_lidar {

class DeskewNodelet : public atlas_ros::StageNodelet<atlas::DeskewParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::DeskewParams& params) override {
    const atlas::StageFactory factory = atlas::bindDeskew(link, params);
    for (const std::string& lidar : params.lidars) {
      clouds_.push_back(getNodeHandle().advertise<sensor_msgs::PointCloud2>(lidar + "/points_deskewed",
                                                                            atlas_ros::kKeepAll));
    }
    return [this, factory] {
      auto stage = factory();
      auto& deskew = static_cast<atlas::DeskewStage&>(*stage);
      deskew.on_batches = [this, emit = deskew.on_batches](std::size_t lidar,
                                                           const atlas::BatchedSweepPtr& batched) {
        emit(lidar, batched);
        publishCloud(lidar, *batched);
      };
      return stage;
    };
  }

  /// Not an input of any stage: only made when somebody listens.
  void publishCloud(std::size_t lidar, const atlas::BatchedSweep& batched) {
    if (clouds_[lidar].getNumSubscribers() > 0)
      clouds_[lidar].publish(atlas_ros::toMsg(atlas::deskewed(batched)));
  }

  std::vector<ros::Publisher> clouds_;
};

}  // namespace atlas_lidar

PLUGINLIB_EXPORT_CLASS(atlas_lidar::DeskewNodelet, nodelet::Nodelet)
