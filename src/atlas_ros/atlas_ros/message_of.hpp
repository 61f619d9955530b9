// SPDX-License-Identifier: MIT
// Which message carries which value between stages. Used by StageLink; one line per type.
#pragma once

#include <memory>

#include "atlas_ros/conversions.hpp"
#include "atlas_ros/grid_conversions.hpp"
#include "atlas_ros/object_conversions.hpp"
#include "atlas_ros/point_cloud.hpp"

namespace atlas_ros {

template <class T>
struct MessageOf;

/// A type whose conversions are plain toMsg and fromMsg.
#define ATLAS_MESSAGE_OF(Type, MessageType)                                               \
  template <>                                                                             \
  struct MessageOf<Type> {                                                                \
    using Message = MessageType;                                                          \
    static Message to(const Type& value) { return toMsg(value); }                         \
    static atlas::Outcome<Type> from(const Message& message) { return fromMsg(message); } \
  }

ATLAS_MESSAGE_OF(atlas::ImuSample, sensor_msgs::Imu);
ATLAS_MESSAGE_OF(atlas::MagneticSample, sensor_msgs::MagneticField);
ATLAS_MESSAGE_OF(atlas::TimeReference, sensor_msgs::TimeReference);
ATLAS_MESSAGE_OF(atlas::GnssFix, sensor_msgs::NavSatFix);
ATLAS_MESSAGE_OF(atlas::CameraInfo, sensor_msgs::CameraInfo);
ATLAS_MESSAGE_OF(atlas::Detections, atlas_msgs::Detection2dArray);
ATLAS_MESSAGE_OF(atlas::TemperatureRange, atlas_msgs::TemperatureRange);
ATLAS_MESSAGE_OF(atlas::RadarScan, atlas_msgs::RadarScan);
ATLAS_MESSAGE_OF(atlas::Odometry, nav_msgs::Odometry);
ATLAS_MESSAGE_OF(atlas::Obstacles, atlas_msgs::ObstacleArray);
ATLAS_MESSAGE_OF(atlas::Lines, atlas_msgs::LineArray);
ATLAS_MESSAGE_OF(atlas::Frustums, atlas_msgs::FrustumArray);
ATLAS_MESSAGE_OF(atlas::ProjectedDetections, atlas_msgs::ProjectedDetections);
ATLAS_MESSAGE_OF(atlas::SensorStatus, atlas_msgs::SensorStatus);
ATLAS_MESSAGE_OF(atlas::ProductOrigins, atlas_msgs::ProductOrigins);
ATLAS_MESSAGE_OF(atlas::RiskAnswer, atlas_msgs::CollisionRisk);
#undef ATLAS_MESSAGE_OF

template <>
struct MessageOf<atlas::StaticTransforms> {
  using Message = tf2_msgs::TFMessage;
  static atlas::Outcome<atlas::StaticTransforms> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::GnssHeading> {
  using Message = sensor_msgs::Imu;
  static Message to(const atlas::GnssHeading& value) { return toMsg(value); }
  static atlas::Outcome<atlas::GnssHeading> from(const Message& message) { return headingFromMsg(message); }
};
/// Pressures: the only plain numbers that a stage takes from a topic.
template <>
struct MessageOf<atlas::ScalarSample> {
  using Message = sensor_msgs::FluidPressure;
  static atlas::Outcome<atlas::ScalarSample> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::Anchor> {
  using Message = sensor_msgs::NavSatFix;
  static Message to(const atlas::Anchor& value) { return toMsg(value); }
  static atlas::Outcome<atlas::Anchor> from(const Message& message) { return anchorFromMsg(message); }
};
template <>
struct MessageOf<atlas::SweepPtr> {
  using Message = sensor_msgs::PointCloud2;
  static Message to(const atlas::SweepPtr& value) { return toMsg(*value); }
  static atlas::Outcome<atlas::SweepPtr> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::BatchedSweepPtr> {
  using Message = atlas_msgs::PointBatches;
  static Message to(const atlas::BatchedSweepPtr& value) { return toMsg(*value); }
  static atlas::Outcome<atlas::BatchedSweepPtr> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::MapCloudPtr> {
  using Message = sensor_msgs::PointCloud2;
  static Message to(const atlas::MapCloudPtr& value) { return toCloud(value->points, value->stamp, "map"); }
  static atlas::Outcome<atlas::MapCloudPtr> from(const Message& message) {
    const auto sweep = fromMsg(message);
    if (!sweep) return sweep.reason();
    auto cloud = std::make_shared<atlas::MapCloud>();
    cloud->stamp = (*sweep)->stamp;
    cloud->points = (*sweep)->points;
    return atlas::MapCloudPtr(cloud);
  }
};
template <>
struct MessageOf<atlas::ObjectsPtr> {
  using Message = atlas_msgs::ObjectArray;
  static Message to(const atlas::ObjectsPtr& value) { return toMsg(*value); }
  static atlas::Outcome<atlas::ObjectsPtr> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::SensorGridPtr> {
  using Message = atlas_msgs::SensorGrid;
  static Message to(const atlas::SensorGridPtr& value) { return toMsg(*value); }
  static atlas::Outcome<atlas::SensorGridPtr> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::StereoDisparityPtr> {
  using Message = stereo_msgs::DisparityImage;
  static Message to(const atlas::StereoDisparityPtr& value) { return toMsg(*value); }
};
template <>
struct MessageOf<atlas::OccupancyMapPtr> {
  using Message = nav_msgs::OccupancyGrid;
  static Message to(const atlas::OccupancyMapPtr& value) { return toMsg(*value); }
  static atlas::Outcome<atlas::OccupancyMapPtr> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::GridVelocities> {
  using Message = atlas_msgs::VelocityGrid;
  static Message to(const atlas::GridVelocities& value) { return toMsg(value); }
};
template <>
struct MessageOf<atlas::LocalMapView> {
  using Message = atlas_msgs::LocalMap;
  static Message to(const atlas::LocalMapView& value) { return toMsg(value); }
};
template <>
struct MessageOf<atlas::VideoPacketPtr> {
  using Message = atlas_msgs::VideoPacket;
  static Message to(const atlas::VideoPacketPtr& value) { return toMsg(*value); }
  static atlas::Outcome<atlas::VideoPacketPtr> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::ImagePtr> {
  using Message = sensor_msgs::Image;
  static Message to(const atlas::ImagePtr& value) { return toImageMsg(*value); }
  static atlas::Outcome<atlas::ImagePtr> from(const Message& message) { return fromMsg(message); }
};
template <>
struct MessageOf<atlas::EncodedImage> {
  using Message = sensor_msgs::CompressedImage;
  static Message to(const atlas::EncodedImage& value) { return toCompressedMsg(*value.image); }
  static atlas::Outcome<atlas::EncodedImage> from(const Message& message) {
    return atlas::EncodedImage{fromMsg(message)};
  }
};
/// Depth images travel as sensor_msgs/Image (REP-118); the image index is the receiver's own count.
template <>
struct MessageOf<atlas::DepthImagePtr> {
  using Message = sensor_msgs::Image;
  static Message to(const atlas::DepthImagePtr& value) { return toMsg(*value); }
  static atlas::Outcome<atlas::DepthImagePtr> from(const Message& message) {
    auto depth = std::make_shared<atlas::DepthImage>();
    depth->stamp = fromTime(message.header.stamp);
    depth->camera_info.frame = message.header.frame_id;
    if (message.width == 0) return atlas::DepthImagePtr(depth);  // the answer of a stage that had nothing
    const auto image = fromMsg(message);
    if (!image) return image.reason();
    depth->depth = (*image)->pixels;
    return atlas::DepthImagePtr(depth);
  }
};

}  // namespace atlas_ros
