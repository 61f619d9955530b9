// SPDX-License-Identifier: MIT
#include <cstring>
#include <memory>

#include "atlas_ros/conversions.hpp"

namespace atlas_ros {
namespace {

int matType(const std::string& encoding) {
  if (encoding == "bgr8" || encoding == "rgb8") return CV_8UC3;
  if (encoding == "mono8" || encoding == "8UC1") return CV_8UC1;
  if (encoding == "mono16" || encoding == "16UC1") return CV_16UC1;
  if (encoding == "32FC1") return CV_32FC1;
  return -1;
}

sensor_msgs::Image imageMsg(const cv::Mat& pixels, const std::string& encoding, atlas::Stamp stamp,
                            const std::string& frame) {
  sensor_msgs::Image msg;
  msg.header.stamp = toTime(stamp);
  msg.header.frame_id = frame;
  msg.height = static_cast<std::uint32_t>(pixels.rows);
  msg.width = static_cast<std::uint32_t>(pixels.cols);
  msg.encoding = encoding;
  msg.is_bigendian = 0;
  msg.step = static_cast<std::uint32_t>(static_cast<std::size_t>(pixels.cols) * pixels.elemSize());
  msg.data.resize(static_cast<std::size_t>(msg.step) * msg.height);
  for (int row = 0; row < pixels.rows; ++row) {
    std::memcpy(msg.data.data() + static_cast<std::size_t>(row) * msg.step, pixels.ptr(row), msg.step);
  }
  return msg;
}

}  // namespace

sensor_msgs::CameraInfo toMsg(const atlas::CameraInfo& info) {
  sensor_msgs::CameraInfo msg;
  msg.header.stamp = toTime(info.stamp);
  msg.header.frame_id = info.frame;
  msg.width = info.width;
  msg.height = info.height;
  msg.distortion_model = info.distortion_model;
  msg.D = info.distortion;
  std::copy(info.K.begin(), info.K.end(), msg.K.begin());
  std::copy(info.R.begin(), info.R.end(), msg.R.begin());
  std::copy(info.P.begin(), info.P.end(), msg.P.begin());
  return msg;
}
atlas::CameraInfo fromMsg(const sensor_msgs::CameraInfo& msg) {
  atlas::CameraInfo info;
  info.stamp = fromTime(msg.header.stamp);
  info.frame = msg.header.frame_id;
  info.width = msg.width;
  info.height = msg.height;
  info.distortion_model = msg.distortion_model;
  info.distortion = msg.D;
  std::copy(msg.K.begin(), msg.K.end(), info.K.begin());
  std::copy(msg.R.begin(), msg.R.end(), info.R.begin());
  std::copy(msg.P.begin(), msg.P.end(), info.P.begin());
  return info;
}

atlas_msgs::VideoPacket toMsg(const atlas::VideoPacket& packet) {
  atlas_msgs::VideoPacket msg;
  msg.header.stamp = toTime(packet.stamp);
  msg.header.frame_id = packet.frame;
  msg.codec = packet.codec;
  msg.keyframe = packet.keyframe;
  msg.decode_index = packet.decode_index;
  msg.pts_index = packet.pts_index;
  msg.extradata = packet.extradata;
  msg.data = packet.data;
  return msg;
}
atlas::VideoPacketPtr fromMsg(const atlas_msgs::VideoPacket& msg) {
  auto packet = std::make_shared<atlas::VideoPacket>();
  packet->stamp = fromTime(msg.header.stamp);
  packet->frame = msg.header.frame_id;
  packet->codec = msg.codec;
  packet->keyframe = msg.keyframe != 0;
  packet->decode_index = msg.decode_index;
  packet->pts_index = msg.pts_index;
  packet->extradata = msg.extradata;
  packet->data = msg.data;
  return packet;
}

sensor_msgs::CompressedImage toCompressedMsg(const atlas::Image& image) {
  sensor_msgs::CompressedImage msg;
  msg.header.stamp = toTime(image.stamp);
  msg.header.frame_id = image.frame;
  msg.format = image.format;
  msg.data = image.encoded;
  return msg;
}
atlas::ImagePtr fromMsg(const sensor_msgs::CompressedImage& msg) {
  auto image = std::make_shared<atlas::Image>();
  image->stamp = fromTime(msg.header.stamp);
  image->frame = msg.header.frame_id;
  image->format = msg.format;
  image->encoded = msg.data;
  return image;
}

sensor_msgs::Image toImageMsg(const atlas::Image& image) {
  return imageMsg(image.pixels, image.format, image.stamp, image.frame);
}
atlas::Outcome<atlas::ImagePtr> fromMsg(const sensor_msgs::Image& msg) {
  const int type = matType(msg.encoding);
  if (type < 0 || msg.width == 0 || msg.height == 0) return atlas::Reason::kBadLayout;
  const std::size_t row = static_cast<std::size_t>(msg.width) * CV_ELEM_SIZE(type);
  if (msg.step < row || msg.data.size() < static_cast<std::size_t>(msg.step) * msg.height)
    return atlas::Reason::kBadLayout;
  auto image = std::make_shared<atlas::Image>();
  image->stamp = fromTime(msg.header.stamp);
  image->frame = msg.header.frame_id;
  image->format = msg.encoding;
  image->pixels.create(static_cast<int>(msg.height), static_cast<int>(msg.width), type);
  for (int r = 0; r < image->pixels.rows; ++r) {
    std::memcpy(image->pixels.ptr(r), msg.data.data() + static_cast<std::size_t>(r) * msg.step, row);
  }
  return atlas::ImagePtr(image);
}

sensor_msgs::Image toMsg(const atlas::DepthImage& depth) {
  return imageMsg(depth.depth, "32FC1", depth.stamp, depth.camera_info.frame);
}

atlas_msgs::Detection2dArray toMsg(const atlas::Detections& detections) {
  atlas_msgs::Detection2dArray msg;
  msg.header.stamp = toTime(detections.stamp);
  msg.header.frame_id = detections.frame;
  msg.image_index = detections.image_index;
  for (const atlas::Detection2d& box : detections.boxes) msg.detections.push_back(toMsg(box));
  return msg;
}
atlas::Detections fromMsg(const atlas_msgs::Detection2dArray& msg) {
  atlas::Detections detections;
  detections.stamp = fromTime(msg.header.stamp);
  detections.frame = msg.header.frame_id;
  detections.image_index = msg.image_index;
  for (const atlas_msgs::Detection2d& m : msg.detections) detections.boxes.push_back(fromMsg(m));
  return detections;
}

atlas_msgs::Detection2d toMsg(const atlas::Detection2d& box) {
  atlas_msgs::Detection2d msg;
  msg.x_min = box.x_min;
  msg.y_min = box.y_min;
  msg.x_max = box.x_max;
  msg.y_max = box.y_max;
  msg.class_id = box.class_id;
  msg.confidence = box.confidence;
  return msg;
}
atlas::Detection2d fromMsg(const atlas_msgs::Detection2d& msg) {
  atlas::Detection2d box;
  box.x_min = msg.x_min;
  box.y_min = msg.y_min;
  box.x_max = msg.x_max;
  box.y_max = msg.y_max;
  box.class_id = msg.class_id;
  box.confidence = msg.confidence;
  return box;
}

}  // namespace atlas_ros
