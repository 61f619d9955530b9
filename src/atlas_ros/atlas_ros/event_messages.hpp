// SPDX-License-Identifier: MIT
// Which message carries which event, in both directions: used by the player, the converter and the bag
// reader.
#pragma once

#include <boost/make_shared.hpp>
#include <stdexcept>
#include <string>

#include "atlas/sensor/record_reader.hpp"
#include "atlas_ros/conversions.hpp"
#include "atlas_ros/point_cloud.hpp"

namespace atlas_ros {

/// Calls `use(boost::shared_ptr<Message>)` with the message of an event of a stream of this kind.
template <class Use>
void withMessage(atlas::StreamKind kind, const atlas::Event& event, Use&& use) {
  using atlas::StreamKind;
  const auto give = [&use](auto message) { use(boost::make_shared<decltype(message)>(std::move(message))); };
  const atlas::Payload& p = event.payload;
  switch (kind) {
    case StreamKind::kStaticTransforms:
      return give(toMsg(std::get<atlas::StaticTransforms>(p), event.stamp));
    case StreamKind::kImu:
      return give(toMsg(std::get<atlas::ImuSample>(p)));
    case StreamKind::kMagnetic:
      return give(toMsg(std::get<atlas::MagneticSample>(p)));
    case StreamKind::kPressure:
      return give(toPressureMsg(std::get<atlas::ScalarSample>(p)));
    case StreamKind::kTemperature:
      return give(toTemperatureMsg(std::get<atlas::ScalarSample>(p)));
    case StreamKind::kTimeReference:
      return give(toMsg(std::get<atlas::TimeReference>(p)));
    case StreamKind::kGnssFix:
      return give(toMsg(std::get<atlas::GnssFix>(p)));
    case StreamKind::kGnssHeading:
      return give(toMsg(std::get<atlas::GnssHeading>(p)));
    case StreamKind::kPoints:
      return give(toMsg(*std::get<atlas::SweepPtr>(p)));
    case StreamKind::kCameraInfo:
      return give(toMsg(std::get<atlas::CameraInfo>(p)));
    case StreamKind::kVideoPackets:
      return give(toMsg(*std::get<atlas::VideoPacketPtr>(p)));
    case StreamKind::kCompressedImage:
      return give(toCompressedMsg(*std::get<atlas::ImagePtr>(p)));
    case StreamKind::kImage:
      return give(toImageMsg(*std::get<atlas::ImagePtr>(p)));
    case StreamKind::kDetections:
      return give(toMsg(std::get<atlas::Detections>(p)));
    case StreamKind::kTemperatureRange:
      return give(toMsg(std::get<atlas::TemperatureRange>(p)));
    case StreamKind::kRadar:
      return give(toMsg(std::get<atlas::RadarScan>(p)));
  }
  throw std::logic_error("stream of unknown kind");
}

/// Calls `use(T*)` (a null pointer, for its type only) with the message type of a stream kind.
template <class Use>
void withMessageType(atlas::StreamKind kind, Use&& use) {
  using atlas::StreamKind;
  switch (kind) {
    case StreamKind::kStaticTransforms:
      return use(static_cast<tf2_msgs::TFMessage*>(nullptr));
    case StreamKind::kImu:
    case StreamKind::kGnssHeading:
      return use(static_cast<sensor_msgs::Imu*>(nullptr));
    case StreamKind::kMagnetic:
      return use(static_cast<sensor_msgs::MagneticField*>(nullptr));
    case StreamKind::kPressure:
      return use(static_cast<sensor_msgs::FluidPressure*>(nullptr));
    case StreamKind::kTemperature:
      return use(static_cast<sensor_msgs::Temperature*>(nullptr));
    case StreamKind::kTimeReference:
      return use(static_cast<sensor_msgs::TimeReference*>(nullptr));
    case StreamKind::kGnssFix:
      return use(static_cast<sensor_msgs::NavSatFix*>(nullptr));
    case StreamKind::kPoints:
      return use(static_cast<sensor_msgs::PointCloud2*>(nullptr));
    case StreamKind::kCameraInfo:
      return use(static_cast<sensor_msgs::CameraInfo*>(nullptr));
    case StreamKind::kVideoPackets:
      return use(static_cast<atlas_msgs::VideoPacket*>(nullptr));
    case StreamKind::kCompressedImage:
      return use(static_cast<sensor_msgs::CompressedImage*>(nullptr));
    case StreamKind::kImage:
      return use(static_cast<sensor_msgs::Image*>(nullptr));
    case StreamKind::kDetections:
      return use(static_cast<atlas_msgs::Detection2dArray*>(nullptr));
    case StreamKind::kTemperatureRange:
      return use(static_cast<atlas_msgs::TemperatureRange*>(nullptr));
    case StreamKind::kRadar:
      return use(static_cast<atlas_msgs::RadarScan*>(nullptr));
  }
  throw std::logic_error("stream of unknown kind");
}

/// Kind of a topic by its message type (and, for Imu, its name); nullopt for types the suite does not use.
std::optional<atlas::StreamKind> kindOf(const std::string& topic, const std::string& datatype);

/// The event's payload of a message of the given kind; the reason when the message is unusable.
template <class Message>
atlas::Outcome<atlas::Payload> toPayload(atlas::StreamKind kind, const Message& msg) {
  if constexpr (std::is_same_v<Message, sensor_msgs::Imu>) {
    if (kind == atlas::StreamKind::kGnssHeading) {
      const auto heading = headingFromMsg(msg);
      if (!heading) return heading.reason();
      return atlas::Payload(*heading);
    }
  }
  (void)kind;
  auto value = fromMsg(msg);
  using Value = decltype(value);
  if constexpr (std::is_constructible_v<atlas::Payload, Value>) {
    return atlas::Payload(std::move(value));
  } else {
    if (!value) return value.reason();
    return atlas::Payload(*value);
  }
}
/// Stamp of a message: its header's, or of its first transform.
template <class Message>
atlas::Stamp stampOf(const Message& msg) {
  return fromTime(msg.header.stamp);
}
inline atlas::Stamp stampOf(const tf2_msgs::TFMessage& msg) {
  return msg.transforms.empty() ? 0 : fromTime(msg.transforms.front().header.stamp);
}

}  // namespace atlas_ros
