// SPDX-License-Identifier: MIT
// Nodelet: detections by a YOLO model that the user brings, for recordings that carry none.
#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"
#include "detector_network.hpp"

namespace atlas {  // found by argument-dependent lookup

template <class Reader>
void readParams(Reader& reader, DetectorParams& p) {
  std::vector<std::string> names;
  reader.read("model", p.model);
  reader.read("cameras", p.cameras);
  reader.readOptional("input_px", p.input_px);
  reader.readOptional("min_confidence", p.limits.confidence);
  reader.readOptional("max_overlap", p.limits.overlap);
  reader.readOptional("max_detections", p.limits.most);
  reader.readOptional("class_names", names);
  p.class_ids = atlas_fusion::classIds(names);
  p.classes = static_cast<int>(names.size());
}

}  // namespace atlas

namespace atlas_fusion {

class DetectorNodelet : public atlas_ros::StageNodelet<atlas::DetectorParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::DetectorParams& params) override {
    validate(params);
    return atlas::bindDetector(link, params, loadNetwork(params));
  }
};

}  // namespace atlas_fusion

PLUGINLIB_EXPORT_CLASS(atlas_fusion::DetectorNodelet, nodelet::Nodelet)
