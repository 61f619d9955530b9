// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "atlas_ros/conversions.hpp"

namespace atlas_ros {
namespace {

constexpr const char* kBaseFrame = "base_link";
constexpr double kUnknown = -1.0;  // REP-145: first covariance element of a quantity that is not measured

bool finite(const geometry_msgs::Vector3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

geometry_msgs::Quaternion quaternion(const Eigen::Quaterniond& q) {
  geometry_msgs::Quaternion msg;
  msg.x = q.x();
  msg.y = q.y();
  msg.z = q.z();
  msg.w = q.w();
  return msg;
}

atlas::Outcome<Eigen::Quaterniond> fromQuaternion(const geometry_msgs::Quaternion& msg) {
  const Eigen::Quaterniond q(msg.w, msg.x, msg.y, msg.z);
  const double norm = q.norm();
  if (!std::isfinite(norm)) return atlas::Reason::kNotFinite;
  constexpr double kTolerance = 1e-3;  // files carry about six digits
  if (std::abs(norm - 1.0) > kTolerance) return atlas::Reason::kNotNormalized;
  return q;
}

}  // namespace

geometry_msgs::Vector3 vector3(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 msg;
  msg.x = v.x();
  msg.y = v.y();
  msg.z = v.z();
  return msg;
}

geometry_msgs::Point point(const Eigen::Vector3d& p) {
  geometry_msgs::Point msg;
  msg.x = p.x();
  msg.y = p.y();
  msg.z = p.z();
  return msg;
}

ros::Time toTime(atlas::Stamp stamp) {
  if (stamp < 0 || stamp / atlas::kSecond > static_cast<atlas::Stamp>(UINT32_MAX)) {
    throw std::invalid_argument("stamp " + std::to_string(stamp) + " ns cannot be a ros::Time");
  }
  return {static_cast<std::uint32_t>(stamp / atlas::kSecond),
          static_cast<std::uint32_t>(stamp % atlas::kSecond)};
}

atlas::Stamp fromTime(const ros::Time& time) {
  return static_cast<atlas::Stamp>(time.sec) * atlas::kSecond + static_cast<atlas::Stamp>(time.nsec);
}

geometry_msgs::Pose toMsg(const atlas::Pose& pose) {
  geometry_msgs::Pose msg;
  msg.position.x = pose.translation.x();
  msg.position.y = pose.translation.y();
  msg.position.z = pose.translation.z();
  msg.orientation = quaternion(pose.rotation);
  return msg;
}

atlas::Outcome<atlas::Pose> fromMsg(const geometry_msgs::Pose& msg) {
  const auto rotation = fromQuaternion(msg.orientation);
  if (!rotation) return rotation.reason();
  const Eigen::Vector3d translation(msg.position.x, msg.position.y, msg.position.z);
  if (!translation.allFinite()) return atlas::Reason::kNotFinite;
  return atlas::Pose{*rotation, translation};
}

tf2_msgs::TFMessage toMsg(const atlas::StaticTransforms& transforms, atlas::Stamp stamp) {
  tf2_msgs::TFMessage msg;
  for (const atlas::StaticTransform& t : transforms.transforms) {
    geometry_msgs::TransformStamped m;
    m.header.stamp = toTime(stamp);
    m.header.frame_id = t.parent;
    m.child_frame_id = t.child;
    m.transform.translation = vector3(t.T_parent_child.translation);
    m.transform.rotation = quaternion(t.T_parent_child.rotation);
    msg.transforms.push_back(m);
  }
  return msg;
}

atlas::Outcome<atlas::StaticTransforms> fromMsg(const tf2_msgs::TFMessage& msg) {
  atlas::StaticTransforms result;
  for (const geometry_msgs::TransformStamped& m : msg.transforms) {
    const auto rotation = fromQuaternion(m.transform.rotation);
    if (!rotation) return rotation.reason();
    if (!finite(m.transform.translation)) return atlas::Reason::kNotFinite;
    result.transforms.push_back(
        {m.header.frame_id, m.child_frame_id, {*rotation, fromXyz(m.transform.translation)}});
  }
  return result;
}

sensor_msgs::Imu toMsg(const atlas::ImuSample& sample) {
  sensor_msgs::Imu msg;
  msg.header.stamp = toTime(sample.stamp);
  msg.header.frame_id = kBaseFrame;
  msg.angular_velocity = vector3(sample.angular_velocity_radps);
  msg.linear_acceleration = vector3(sample.linear_acceleration_mps2);
  if (sample.orientation) {
    msg.orientation = quaternion(*sample.orientation);
  } else {
    msg.orientation_covariance[0] = kUnknown;
  }
  return msg;
}

atlas::Outcome<atlas::ImuSample> fromMsg(const sensor_msgs::Imu& msg) {
  if (!finite(msg.angular_velocity) || !finite(msg.linear_acceleration)) return atlas::Reason::kNotFinite;
  atlas::ImuSample sample;
  sample.stamp = fromTime(msg.header.stamp);
  sample.angular_velocity_radps = fromXyz(msg.angular_velocity);
  sample.linear_acceleration_mps2 = fromXyz(msg.linear_acceleration);
  const auto& o = msg.orientation;
  const bool all_zero =
      o.x == 0 && o.y == 0 && o.z == 0 && o.w == 0;  // drivers without orientation leave it so
  if (msg.orientation_covariance[0] != kUnknown && !all_zero) {
    const auto orientation = fromQuaternion(msg.orientation);
    if (!orientation) return orientation.reason();
    sample.orientation = *orientation;
  }
  return sample;
}

sensor_msgs::MagneticField toMsg(const atlas::MagneticSample& sample) {
  sensor_msgs::MagneticField msg;
  msg.header.stamp = toTime(sample.stamp);
  msg.header.frame_id = kBaseFrame;
  msg.magnetic_field = vector3(sample.field);
  return msg;
}
atlas::MagneticSample fromMsg(const sensor_msgs::MagneticField& msg) {
  return {fromTime(msg.header.stamp), fromXyz(msg.magnetic_field)};
}

sensor_msgs::FluidPressure toPressureMsg(const atlas::ScalarSample& sample) {
  sensor_msgs::FluidPressure msg;
  msg.header.stamp = toTime(sample.stamp);
  msg.header.frame_id = kBaseFrame;
  msg.fluid_pressure = sample.value;
  return msg;
}
sensor_msgs::Temperature toTemperatureMsg(const atlas::ScalarSample& sample) {
  sensor_msgs::Temperature msg;
  msg.header.stamp = toTime(sample.stamp);
  msg.header.frame_id = kBaseFrame;
  msg.temperature = sample.value;
  return msg;
}
atlas::ScalarSample fromMsg(const sensor_msgs::FluidPressure& msg) {
  return {fromTime(msg.header.stamp), msg.fluid_pressure};
}
atlas::ScalarSample fromMsg(const sensor_msgs::Temperature& msg) {
  return {fromTime(msg.header.stamp), msg.temperature};
}

sensor_msgs::TimeReference toMsg(const atlas::TimeReference& reference) {
  sensor_msgs::TimeReference msg;
  msg.header.stamp = toTime(reference.stamp);
  msg.time_ref = toTime(reference.sensor_time);
  msg.source = reference.source;
  return msg;
}
atlas::TimeReference fromMsg(const sensor_msgs::TimeReference& msg) {
  return {fromTime(msg.header.stamp), fromTime(msg.time_ref), msg.source};
}

sensor_msgs::NavSatFix toMsg(const atlas::GnssFix& fix) {
  sensor_msgs::NavSatFix msg;
  msg.header.stamp = toTime(fix.stamp);
  msg.header.frame_id = fix.frame;
  msg.status.status = sensor_msgs::NavSatStatus::STATUS_FIX;
  msg.status.service = sensor_msgs::NavSatStatus::SERVICE_GPS;
  msg.latitude = fix.position.latitude_deg;
  msg.longitude = fix.position.longitude_deg;
  msg.altitude = fix.position.altitude_m;
  msg.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN;
  if (fix.covariance_enu_m2) {
    msg.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_KNOWN;
    std::copy(fix.covariance_enu_m2->begin(), fix.covariance_enu_m2->end(), msg.position_covariance.begin());
  }
  return msg;
}

atlas::Outcome<atlas::GnssFix> fromMsg(const sensor_msgs::NavSatFix& msg) {
  if (msg.status.status < sensor_msgs::NavSatStatus::STATUS_FIX) return atlas::Reason::kEmpty;
  if (!std::isfinite(msg.latitude) || !std::isfinite(msg.longitude) || !std::isfinite(msg.altitude)) {
    return atlas::Reason::kNotFinite;
  }
  atlas::GnssFix fix;
  fix.stamp = fromTime(msg.header.stamp);
  fix.frame = msg.header.frame_id;
  fix.position = {msg.latitude, msg.longitude, msg.altitude};
  if (msg.position_covariance_type != sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN) {
    fix.covariance_enu_m2.emplace();
    std::copy(msg.position_covariance.begin(), msg.position_covariance.end(), fix.covariance_enu_m2->begin());
  }
  return fix;
}

sensor_msgs::Imu toMsg(const atlas::GnssHeading& heading) {
  sensor_msgs::Imu msg;
  msg.header.stamp = toTime(heading.stamp);
  msg.header.frame_id = kBaseFrame;
  msg.orientation.z = std::sin(0.5 * heading.yaw_rad);
  msg.orientation.w = std::cos(0.5 * heading.yaw_rad);
  constexpr double kUnmeasured = 1e6;  // rad^2: roll and pitch carry no information
  if (heading.variance_rad2) {  // otherwise all zeros: "covariance unknown" by the definition of the message
    msg.orientation_covariance[0] = kUnmeasured;
    msg.orientation_covariance[4] = kUnmeasured;
    msg.orientation_covariance[8] = *heading.variance_rad2;
  }
  msg.angular_velocity_covariance[0] = kUnknown;
  msg.linear_acceleration_covariance[0] = kUnknown;
  return msg;
}

atlas::Outcome<atlas::GnssHeading> headingFromMsg(const sensor_msgs::Imu& msg) {
  if (msg.orientation_covariance[0] == kUnknown) return atlas::Reason::kEmpty;
  const auto q = fromQuaternion(msg.orientation);
  if (!q) return q.reason();
  atlas::GnssHeading heading;
  heading.stamp = fromTime(msg.header.stamp);
  heading.yaw_rad = atlas::toRollPitchYaw(*q).yaw;
  if (msg.orientation_covariance[8] > 0.0) heading.variance_rad2 = msg.orientation_covariance[8];
  return heading;
}

atlas_msgs::TemperatureRange toMsg(const atlas::TemperatureRange& range) {
  atlas_msgs::TemperatureRange msg;
  msg.header.stamp = toTime(range.stamp);
  msg.minimum_degc = range.minimum_degc;
  msg.maximum_degc = range.maximum_degc;
  return msg;
}
atlas::TemperatureRange fromMsg(const atlas_msgs::TemperatureRange& msg) {
  return {fromTime(msg.header.stamp), msg.minimum_degc, msg.maximum_degc};
}

atlas_msgs::RadarScan toMsg(const atlas::RadarScan& scan) {
  atlas_msgs::RadarScan msg;
  msg.header.stamp = toTime(scan.stamp);
  msg.header.frame_id = scan.frame;
  for (const atlas::RadarTarget& target : scan.targets) {
    atlas_msgs::RadarTarget m;
    m.position.x = target.position.x();
    m.position.y = target.position.y();
    m.position.z = target.position.z();
    m.radial_velocity_mps = target.radial_velocity_mps;
    msg.targets.push_back(m);
  }
  return msg;
}
atlas::RadarScan fromMsg(const atlas_msgs::RadarScan& msg) {
  atlas::RadarScan scan;
  scan.stamp = fromTime(msg.header.stamp);
  scan.frame = msg.header.frame_id;
  for (const atlas_msgs::RadarTarget& m : msg.targets) {
    scan.targets.push_back({{m.position.x, m.position.y, m.position.z}, m.radial_velocity_mps});
  }
  return scan;
}

}  // namespace atlas_ros
