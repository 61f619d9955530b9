// SPDX-License-Identifier: MIT
// Every message <-> core conversion of the suite. fromMsg validates (finite, normalized, expected layout) and
// answers a reason instead of a guess; toMsg copies the data's own stamp. A value that passes both ways is
// unchanged, bit by bit.
#pragma once

#include <atlas_msgs/Detection2dArray.h>
#include <atlas_msgs/FrustumArray.h>
#include <atlas_msgs/LineArray.h>
#include <atlas_msgs/ObstacleArray.h>
#include <atlas_msgs/PointBatches.h>
#include <atlas_msgs/ProductOrigins.h>
#include <atlas_msgs/ProjectedDetections.h>
#include <atlas_msgs/RadarScan.h>
#include <atlas_msgs/SensorStatus.h>
#include <atlas_msgs/TemperatureRange.h>
#include <atlas_msgs/VideoPacket.h>
#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/Temperature.h>
#include <sensor_msgs/TimeReference.h>
#include <tf2_msgs/TFMessage.h>

#include "atlas/base/outcome.hpp"
#include "atlas/sensor/lines.hpp"
#include "atlas/sensor/products.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas_ros {

/// ROS 1 stamps are unsigned seconds: a stamp before 1970 or after 2106 throws std::invalid_argument.
ros::Time toTime(atlas::Stamp stamp);
atlas::Stamp fromTime(const ros::Time& time);
geometry_msgs::Vector3 vector3(const Eigen::Vector3d& v);
geometry_msgs::Point point(const Eigen::Vector3d& p);
/// Of a geometry_msgs::Point or Vector3.
template <class Message>
Eigen::Vector3d fromXyz(const Message& msg) {
  return {msg.x, msg.y, msg.z};
}

// Sensors
tf2_msgs::TFMessage toMsg(const atlas::StaticTransforms& transforms, atlas::Stamp stamp);
atlas::Outcome<atlas::StaticTransforms> fromMsg(const tf2_msgs::TFMessage& msg);
sensor_msgs::Imu toMsg(
    const atlas::ImuSample& sample);  // frame base_link; covariance[0] = -1 where unknown (REP-145)
atlas::Outcome<atlas::ImuSample> fromMsg(const sensor_msgs::Imu& msg);
sensor_msgs::MagneticField toMsg(const atlas::MagneticSample& sample);
atlas::MagneticSample fromMsg(const sensor_msgs::MagneticField& msg);
sensor_msgs::FluidPressure toPressureMsg(const atlas::ScalarSample& sample);
sensor_msgs::Temperature toTemperatureMsg(const atlas::ScalarSample& sample);
atlas::ScalarSample fromMsg(const sensor_msgs::FluidPressure& msg);
atlas::ScalarSample fromMsg(const sensor_msgs::Temperature& msg);
sensor_msgs::TimeReference toMsg(const atlas::TimeReference& reference);
atlas::TimeReference fromMsg(const sensor_msgs::TimeReference& msg);
sensor_msgs::NavSatFix toMsg(const atlas::GnssFix& fix);
/// A fix with status NO_FIX answers kEmpty.
atlas::Outcome<atlas::GnssFix> fromMsg(const sensor_msgs::NavSatFix& msg);
sensor_msgs::Imu toMsg(const atlas::GnssHeading& heading);  // yaw in orientation; roll and pitch unknown
atlas::Outcome<atlas::GnssHeading> headingFromMsg(const sensor_msgs::Imu& msg);
sensor_msgs::CameraInfo toMsg(const atlas::CameraInfo& info);
atlas::CameraInfo fromMsg(const sensor_msgs::CameraInfo& msg);
atlas_msgs::VideoPacket toMsg(const atlas::VideoPacket& packet);
atlas::VideoPacketPtr fromMsg(const atlas_msgs::VideoPacket& msg);
sensor_msgs::CompressedImage toCompressedMsg(const atlas::Image& image);
atlas::ImagePtr fromMsg(const sensor_msgs::CompressedImage& msg);
sensor_msgs::Image toImageMsg(const atlas::Image& image);
atlas::Outcome<atlas::ImagePtr> fromMsg(const sensor_msgs::Image& msg);
atlas_msgs::Detection2d toMsg(const atlas::Detection2d& box);
atlas::Detection2d fromMsg(const atlas_msgs::Detection2d& msg);
atlas_msgs::Detection2dArray toMsg(const atlas::Detections& detections);
atlas::Detections fromMsg(const atlas_msgs::Detection2dArray& msg);
atlas_msgs::TemperatureRange toMsg(const atlas::TemperatureRange& range);
atlas::TemperatureRange fromMsg(const atlas_msgs::TemperatureRange& msg);
atlas_msgs::RadarScan toMsg(const atlas::RadarScan& scan);
atlas::RadarScan fromMsg(const atlas_msgs::RadarScan& msg);

// Products
nav_msgs::Odometry toMsg(const atlas::Odometry& odometry);  // map -> base_link
atlas::Outcome<atlas::Odometry> fromMsg(const nav_msgs::Odometry& msg);
sensor_msgs::NavSatFix toMsg(const atlas::Anchor& anchor);
atlas::Anchor anchorFromMsg(const sensor_msgs::NavSatFix& msg);
atlas_msgs::PointBatches toMsg(const atlas::BatchedSweep& batched);
atlas::Outcome<atlas::BatchedSweepPtr> fromMsg(const atlas_msgs::PointBatches& msg);
atlas_msgs::ObstacleArray toMsg(const atlas::Obstacles& obstacles);
atlas::Obstacles fromMsg(const atlas_msgs::ObstacleArray& msg);
atlas_msgs::LineArray toMsg(const atlas::Lines& lines);
/// A line of no known kind answers kBadLayout, one with a number that is not finite kNotFinite.
atlas::Outcome<atlas::Lines> fromMsg(const atlas_msgs::LineArray& msg);
atlas_msgs::FrustumArray toMsg(const atlas::Frustums& frustums);
atlas::Frustums fromMsg(const atlas_msgs::FrustumArray& msg);
atlas_msgs::ProjectedDetections toMsg(const atlas::ProjectedDetections& projected);
atlas::ProjectedDetections fromMsg(const atlas_msgs::ProjectedDetections& msg);
atlas_msgs::SensorStatus toMsg(const atlas::SensorStatus& status);
atlas::SensorStatus fromMsg(const atlas_msgs::SensorStatus& msg);
atlas_msgs::Origin toMsg(const atlas::Origin& origin);
atlas::Origin fromMsg(const atlas_msgs::Origin& msg);
atlas_msgs::ProductOrigins toMsg(const atlas::ProductOrigins& product);
atlas::ProductOrigins fromMsg(const atlas_msgs::ProductOrigins& msg);
sensor_msgs::Image toMsg(const atlas::DepthImage& depth);  // 32FC1, REP-118

geometry_msgs::Pose toMsg(const atlas::Pose& pose);
atlas::Outcome<atlas::Pose> fromMsg(const geometry_msgs::Pose& msg);

}  // namespace atlas_ros
