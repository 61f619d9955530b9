// SPDX-License-Identifier: MIT
#include "atlas_ros/event_messages.hpp"

#include <map>

namespace atlas_ros {

std::optional<atlas::StreamKind> kindOf(const std::string& topic, const std::string& datatype) {
  using atlas::StreamKind;
  if (datatype == "tf2_msgs/TFMessage") {
    const std::string name = "tf_static";
    const bool is_static =
        topic.size() >= name.size() && topic.compare(topic.size() - name.size(), name.size(), name) == 0;
    if (!is_static) return std::nullopt;
    return StreamKind::kStaticTransforms;
  }
  if (datatype == "sensor_msgs/Imu") {
    return topic.find("heading") != std::string::npos ? StreamKind::kGnssHeading : StreamKind::kImu;
  }
  static const std::map<std::string, StreamKind> kKinds = {
      {"sensor_msgs/MagneticField", StreamKind::kMagnetic},
      {"sensor_msgs/FluidPressure", StreamKind::kPressure},
      {"sensor_msgs/Temperature", StreamKind::kTemperature},
      {"sensor_msgs/TimeReference", StreamKind::kTimeReference},
      {"sensor_msgs/NavSatFix", StreamKind::kGnssFix},
      {"sensor_msgs/PointCloud2", StreamKind::kPoints},
      {"sensor_msgs/CameraInfo", StreamKind::kCameraInfo},
      {"atlas_msgs/VideoPacket", StreamKind::kVideoPackets},
      {"sensor_msgs/CompressedImage", StreamKind::kCompressedImage},
      {"sensor_msgs/Image", StreamKind::kImage},
      {"atlas_msgs/Detection2dArray", StreamKind::kDetections},
      {"atlas_msgs/TemperatureRange", StreamKind::kTemperatureRange},
      {"atlas_msgs/RadarScan", StreamKind::kRadar}};
  const auto it = kKinds.find(datatype);
  if (it == kKinds.end()) return std::nullopt;
  return it->second;
}

}  // namespace atlas_ros
