// SPDX-License-Identifier: MIT
#include "status_messages.hpp"

namespace atlas_localization {
namespace {

constexpr double kStep_m = 0.5;  // between poses of the path
constexpr std::size_t kMostPoses = 20000;
constexpr std::size_t kGrowth = 100;  // a path of n poses waits for n / 100 more

}  // namespace

atlas_msgs::LocalizationStatus toMsg(const atlas::LocalizationStatus& status) {
  using Message = atlas_msgs::LocalizationStatus;
  using State = atlas::LocalizationStatus::State;
  Message msg;
  msg.header.stamp = atlas_ros::toTime(status.stamp);
  msg.header.frame_id = "map";
  msg.state = status.state == State::kAligning  ? Message::ALIGNING
              : status.state == State::kRunning ? Message::RUNNING
                                                : Message::COASTING;
  msg.fix_age = status.fix_age_s.value_or(-1.0);
  msg.receiver = toString(status.receiver);
  msg.standing = status.standing;
  msg.reinitialized = status.reinitialized;
  msg.jumps = status.jumps;
  msg.last_jump = status.last_jump_m;
  for (const atlas::InnovationStatistics& s : status.innovations) {
    atlas_msgs::InnovationStatistics m;
    m.source = s.source;
    m.dof = static_cast<std::uint32_t>(s.rows);
    m.count = s.used + s.rejected;
    m.used = s.used;
    m.rejected = s.rejected;
    m.mean_nis = s.mean_nis;
    m.last_nis = s.last_nis;
    msg.innovations.push_back(m);
  }
  return msg;
}

atlas_msgs::ImuBias toMsg(const atlas::ImuBias& bias, atlas::Stamp stamp) {
  atlas_msgs::ImuBias msg;
  msg.header.stamp = atlas_ros::toTime(stamp);
  msg.header.frame_id = "base_link";
  msg.gyro = atlas_ros::vector3(bias.gyro_radps);
  msg.gyro_sigma = atlas_ros::vector3(bias.gyro_sigma_radps);
  msg.accel = atlas_ros::vector3(bias.accel_mps2);
  msg.accel_sigma = atlas_ros::vector3(bias.accel_sigma_mps2);
  return msg;
}

sensor_msgs::NavSatFix fusedFix(const atlas::Odometry& odometry, const atlas::LocalEnu& map) {
  const atlas::Geodetic position = map.toGeodetic(odometry.T_map_imu.translation);
  sensor_msgs::NavSatFix msg;
  msg.header.stamp = atlas_ros::toTime(odometry.stamp);
  msg.header.frame_id = "base_link";
  msg.status.status = sensor_msgs::NavSatStatus::STATUS_FIX;
  msg.status.service = sensor_msgs::NavSatStatus::SERVICE_GPS;
  msg.latitude = position.latitude_deg;
  msg.longitude = position.longitude_deg;
  msg.altitude = position.altitude_m;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      msg.position_covariance[3 * row + column] = odometry.pose_covariance[6 * row + column];
  }
  msg.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_KNOWN;
  return msg;
}

std::vector<geometry_msgs::TransformStamped> transformsOf(const atlas::Odometry& odometry) {
  geometry_msgs::TransformStamped odom, base;
  odom.header.stamp = base.header.stamp = atlas_ros::toTime(odometry.stamp);
  odom.header.frame_id = "map";
  odom.child_frame_id = "odom";
  odom.transform.rotation.w = 1.0;
  base.header.frame_id = "odom";
  base.child_frame_id = "base_link";
  base.transform.translation = atlas_ros::vector3(odometry.T_map_imu.translation);
  base.transform.rotation = atlas_ros::toMsg(odometry.T_map_imu).orientation;
  return {odom, base};
}

bool GrowingPath::extend(const atlas::Odometry& odometry) {
  const Eigen::Vector3d& position = odometry.T_map_imu.translation;
  if (!path_.poses.empty() && (position - last_position_).norm() < kStep_m) return false;
  last_position_ = position;
  geometry_msgs::PoseStamped stamped;
  stamped.header.stamp = atlas_ros::toTime(odometry.stamp);
  stamped.header.frame_id = "map";
  stamped.pose = atlas_ros::toMsg(odometry.T_map_imu);
  path_.header = stamped.header;
  path_.poses.push_back(stamped);
  ++waiting_;
  if (path_.poses.size() > kMostPoses) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < path_.poses.size(); i += 2) path_.poses[kept++] = path_.poses[i];
    path_.poses.resize(kept);
  }
  if (waiting_ * kGrowth < path_.poses.size()) return false;
  waiting_ = 0;
  return true;
}

}  // namespace atlas_localization
