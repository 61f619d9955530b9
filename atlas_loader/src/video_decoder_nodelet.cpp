// SPDX-License-Identifier: MIT
// Nodelet: decodes the cameras that a stage or a writer looks at.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"
#include "video_decode_stage.hpp"

namespace atlas_loader {

class VideoDecoderNodelet : public atlas_ros::StageNodelet<VideoDecodeParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const VideoDecodeParams& params) override {
    return bindVideoDecoder(link, params);
  }
};

}  // namespace atlas_loader

PLUGINLIB_EXPORT_CLASS(atlas_loader::VideoDecoderNodelet, nodelet::Nodelet)
