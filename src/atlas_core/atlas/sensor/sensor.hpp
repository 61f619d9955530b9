// SPDX-License-Identifier: MIT
// Plain structs of what the sensors deliver: SI units, radians, stamps of the data. Frames are named at each
// field. Heavy data (points, pixels, packets) is shared by pointer to const and never changed after it was
// made.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "atlas/base/geodesy.hpp"
#include "atlas/base/geometry.hpp"
#include "atlas/base/time.hpp"

namespace atlas {

/// Inertial sample in the imu frame (x forward, y left, z up). At rest linear_acceleration points up
/// (REP-145).
struct ImuSample {
  Stamp stamp = 0;
  Eigen::Vector3d angular_velocity_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_acceleration_mps2 = Eigen::Vector3d::Zero();
  /// R_enu_imu of the IMU's own filter: roll and pitch good, yaw magnetic. Absent when the IMU gives none.
  std::optional<Eigen::Quaterniond> orientation;
};

struct MagneticSample {
  Stamp stamp = 0;
  Eigen::Vector3d field =
      Eigen::Vector3d::Zero();  ///< imu frame; tesla, or the sensor's normalized unit (BUD)
};

/// One number over time: pressure in Pa, temperature in deg C.
struct ScalarSample {
  Stamp stamp = 0;
  double value = 0.0;
};

/// What a sensor's own clock said at `stamp` (imu/time, gnss/time, inner lidar clock).
struct TimeReference {
  Stamp stamp = 0;
  Stamp sensor_time = 0;  ///< UTC, ns
  std::string source;
};

/// Position of a GNSS antenna.
struct GnssFix {
  Stamp stamp = 0;
  Geodetic position;
  /// East, north, up variances and covariances, m^2, row-major; absent when the receiver gives none.
  std::optional<std::array<double, 9>> covariance_enu_m2;
  std::string frame;  ///< frame of the antenna, e.g. "gnss_rear"; its place in the imu frame is the lever arm
};

/// Direction of the vehicle's x axis from a two-antenna receiver: yaw in `map` (counter-clockwise from east).
struct GnssHeading {
  Stamp stamp = 0;
  double yaw_rad = 0.0;
  std::optional<double> variance_rad2;  ///< absent when the receiver gives none
};

/// One return. time: s relative to the sweep's stamp. 24 bytes, laid out as in the PointCloud2 that carries
/// it.
struct LidarPoint {
  float x = 0, y = 0, z = 0;  ///< m, lidar frame; NaN where there was no return
  float intensity = 0;        ///< as recorded
  float time = 0;             ///< s, relative to Sweep::stamp
  std::uint16_t ring = 0;     ///< laser index, counted from the bottom
  std::uint16_t padding = 0;
};
static_assert(sizeof(LidarPoint) == 24, "LidarPoint must match its PointCloud2 layout");

/// One revolution (or frame) of a lidar in the order it was measured.
struct Sweep {
  Stamp stamp = 0;
  std::string frame;  ///< lidar frame
  std::vector<LidarPoint> points;
};
using SweepPtr = std::shared_ptr<const Sweep>;

/// One compressed picture of a video in decoding order. Its own presentation time comes from pts_index: the
/// stamp of the picture with index i is the `stamp` of the packet whose decode_index is i (packets carry the
/// stamps in order).
struct VideoPacket {
  Stamp stamp = 0;
  std::string frame;
  std::string codec;  ///< "hevc", "h264"
  bool keyframe = false;
  std::uint32_t decode_index = 0;       ///< counts packets in the record
  std::uint32_t pts_index = 0;          ///< index of this picture in presentation order
  std::vector<std::uint8_t> extradata;  ///< codec parameters, on keyframes only
  std::vector<std::uint8_t> data;
};
using VideoPacketPtr = std::shared_ptr<const VideoPacket>;

/// An image as stored (JPEG, PNG bytes) or decoded (pixels). Exactly one of `encoded` and `pixels` is filled.
struct Image {
  Stamp stamp = 0;
  std::string frame;   ///< optical frame: x right, y down, z forward (REP-103)
  std::string format;  ///< "jpeg", "png" for encoded; "bgr8", "mono8", "mono16", "32FC1" for pixels
  std::vector<std::uint8_t> encoded;
  cv::Mat pixels;
};
using ImagePtr = std::shared_ptr<const Image>;
/// An image whose `encoded` bytes are filled, where the type has to say so.
struct EncodedImage {
  ImagePtr image;
};

/// Intrinsics as in sensor_msgs/CameraInfo, one per image, with the image's stamp.
struct CameraInfo {
  Stamp stamp = 0;
  std::string frame;                    ///< optical frame
  std::uint32_t width = 0, height = 0;  ///< px
  std::string distortion_model;         ///< "plumb_bob", "rational_polynomial", "equidistant"
  std::vector<double> distortion;       ///< k1, k2, p1, p2, k3, ...
  std::array<double, 9> K{};            ///< row-major, px
  std::array<double, 9> R{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 12> P{};  ///< row-major, px
};

/// One box of an image detector, pixels of the unrectified image, not clipped.
struct Detection2d {
  double x_min = 0, y_min = 0, x_max = 0, y_max = 0;  ///< px
  std::int32_t class_id = 0;                          ///< COCO-80 index
  double confidence = 0;                              ///< 0..1
};

/// All detections of one image. Present (empty) for images without any, when the detector ran on them.
struct Detections {
  Stamp stamp = 0;                ///< of the image
  std::string frame;              ///< optical frame of the camera
  std::uint32_t image_index = 0;  ///< 0-based index of the image in its stream
  std::vector<Detection2d> boxes;
};

/// Temperatures of grey 0 and grey 255 of the thermal image with the same stamp, deg C.
struct TemperatureRange {
  Stamp stamp = 0;
  double minimum_degc = 0, maximum_degc = 0;
};

struct RadarTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, radar frame
  double radial_velocity_mps = 0;                      ///< sign as recorded
};
struct RadarScan {
  Stamp stamp = 0;
  std::string frame;
  std::vector<RadarTarget> targets;
};

/// The sensors' places on the vehicle: T_base_sensor for each sensor frame. base_link is the imu frame.
struct StaticTransform {
  std::string parent, child;
  Pose T_parent_child;
};
struct StaticTransforms {
  std::vector<StaticTransform> transforms;
};

using Payload = std::variant<StaticTransforms, ImuSample, MagneticSample, ScalarSample, TimeReference,
                             GnssFix, GnssHeading, SweepPtr, CameraInfo, VideoPacketPtr, ImagePtr, Detections,
                             TemperatureRange, RadarScan>;

}  // namespace atlas
