// SPDX-License-Identifier: MIT
#include "atlas_ros/grid_conversions.hpp"

#include <algorithm>
#include <cmath>

#include "atlas_ros/conversions.hpp"

namespace atlas_ros {
namespace {

constexpr const char* kMapFrame = "map";

bool isProbability(double p) { return p >= 0.0 && p <= 1.0; }

nav_msgs::MapMetaData metaData(ros::Time stamp, float resolution_m, std::uint32_t columns, std::uint32_t rows,
                               const Eigen::Vector3d& origin) {
  nav_msgs::MapMetaData info;
  info.map_load_time = stamp;
  info.resolution = resolution_m;
  info.width = columns;
  info.height = rows;
  info.origin.position = point(origin);
  info.origin.orientation.w = 1.0;
  return info;
}

}  // namespace

nav_msgs::OccupancyGrid toMsg(const atlas::OccupancyMap& map) {
  nav_msgs::OccupancyGrid msg;
  msg.header.stamp = toTime(map.stamp);
  msg.header.frame_id = kMapFrame;
  msg.info = metaData(msg.header.stamp, map.resolution_m, map.columns, map.rows, map.origin);
  msg.data = map.percent;
  return msg;
}

atlas::Outcome<atlas::OccupancyMapPtr> fromMsg(const nav_msgs::OccupancyGrid& msg) {
  auto map = std::make_shared<atlas::OccupancyMap>();
  map->stamp = fromTime(msg.header.stamp);
  map->resolution_m = msg.info.resolution;
  map->origin = fromXyz(msg.info.origin.position);
  map->columns = msg.info.width;
  map->rows = msg.info.height;
  map->percent = msg.data;
  if (!map->origin.allFinite() || !std::isfinite(map->resolution_m)) return atlas::Reason::kNotFinite;
  if (static_cast<std::size_t>(map->columns) * map->rows != map->percent.size())
    return atlas::Reason::kBadLayout;
  const auto bad = [](std::int8_t p) { return p < -1 || p > 100; };
  if (std::any_of(map->percent.begin(), map->percent.end(), bad)) return atlas::Reason::kBadLayout;
  return atlas::OccupancyMapPtr(map);
}

atlas_msgs::VelocityGrid toMsg(const atlas::GridVelocities& velocities) {
  const atlas::OccupancyFrame& frame = *velocities.frame;
  atlas_msgs::VelocityGrid msg;
  msg.header.stamp = toTime(frame.stamp);
  msg.header.frame_id = kMapFrame;
  if (!frame.cells) return msg;
  const Eigen::Vector2d corner = frame.geometry.corner();
  msg.info =
      metaData(msg.header.stamp, static_cast<float>(frame.geometry.cell_m),
               static_cast<std::uint32_t>(frame.geometry.columns),
               static_cast<std::uint32_t>(frame.geometry.rows), {corner.x(), corner.y(), frame.road_m});
  const atlas::CellEstimates& cells = *frame.cells;
  msg.occupied = cells.occupied;
  msg.unknown = cells.unknown;
  msg.static_share = cells.static_share;
  msg.moving = cells.moving;
  msg.vx = cells.vx_mps;
  msg.vy = cells.vy_mps;
  msg.var_xx = cells.var_xx;
  msg.var_xy = cells.var_xy;
  msg.var_yy = cells.var_yy;
  msg.saturation = cells.saturation;
  return msg;
}

atlas_msgs::CollisionRisk toMsg(const atlas::RiskAnswer& answer) {
  atlas_msgs::CollisionRisk msg;
  msg.header.stamp = toTime(answer.stamp);
  msg.header.frame_id = kMapFrame;
  msg.known = answer.risk.has_value();
  if (!answer.risk) return msg;
  const atlas::CollisionRisk& risk = *answer.risk;
  msg.bin = risk.bin_s;
  msg.first_contact = risk.first_contact;
  msg.total = risk.total;
  msg.expected_time_known = risk.expected_time_s.has_value();
  msg.expected_time = risk.expected_time_s.value_or(0.0);
  msg.unknown_share = risk.unknown_share;
  msg.object_known = risk.object.has_value();
  msg.object = risk.object.value_or(0);
  return msg;
}

atlas::Outcome<atlas::RiskAnswer> fromMsg(const atlas_msgs::CollisionRisk& msg) {
  atlas::RiskAnswer answer{fromTime(msg.header.stamp), std::nullopt};
  if (!msg.known) return answer;
  atlas::CollisionRisk risk;
  risk.stamp = answer.stamp;
  risk.bin_s = msg.bin;
  risk.first_contact = msg.first_contact;
  risk.total = msg.total;
  if (msg.expected_time_known) risk.expected_time_s = msg.expected_time;
  risk.unknown_share = msg.unknown_share;
  if (msg.object_known) risk.object = msg.object;
  const bool sound = std::isfinite(msg.bin) && std::isfinite(msg.expected_time) && isProbability(msg.total) &&
                     isProbability(msg.unknown_share) &&
                     std::all_of(risk.first_contact.begin(), risk.first_contact.end(),
                                 [](double p) { return isProbability(p); });
  if (!sound) return atlas::Reason::kNotFinite;
  answer.risk = std::move(risk);
  return answer;
}

atlas_msgs::SensorGrid toMsg(const atlas::SensorGrid& grid) {
  atlas_msgs::SensorGrid msg;
  msg.header.stamp = toTime(grid.stamp);
  msg.header.frame_id = grid.frame;
  msg.T_sensor_grid = toMsg(grid.T_sensor_grid);
  msg.origin_x = grid.origin_x_m;
  msg.origin_y = grid.origin_y_m;
  msg.cell = grid.cell_m;
  msg.columns = static_cast<std::uint32_t>(grid.columns);
  msg.rows = static_cast<std::uint32_t>(grid.rows);
  msg.occupied = grid.occupied;
  return msg;
}

atlas::Outcome<atlas::SensorGridPtr> fromMsg(const atlas_msgs::SensorGrid& msg) {
  const auto pose = fromMsg(msg.T_sensor_grid);
  if (!pose) return pose.reason();
  auto grid = std::make_shared<atlas::SensorGrid>();
  grid->stamp = fromTime(msg.header.stamp);
  grid->frame = msg.header.frame_id;
  grid->T_sensor_grid = *pose;
  grid->origin_x_m = msg.origin_x;
  grid->origin_y_m = msg.origin_y;
  grid->cell_m = msg.cell;
  grid->columns = static_cast<int>(msg.columns);
  grid->rows = static_cast<int>(msg.rows);
  grid->occupied = msg.occupied;
  if (!std::isfinite(msg.origin_x) || !std::isfinite(msg.origin_y)) return atlas::Reason::kNotFinite;
  const bool sized = static_cast<std::size_t>(msg.columns) * msg.rows == msg.occupied.size();
  if (!sized || (!msg.occupied.empty() && !(msg.cell > 0.0))) return atlas::Reason::kBadLayout;
  const auto bad = [](float p) { return !isProbability(static_cast<double>(p)); };
  if (std::any_of(msg.occupied.begin(), msg.occupied.end(), bad)) return atlas::Reason::kNotFinite;
  return atlas::SensorGridPtr(grid);
}

stereo_msgs::DisparityImage toMsg(const atlas::StereoDisparity& disparity) {
  stereo_msgs::DisparityImage msg;
  msg.header.stamp = toTime(disparity.stamp);
  msg.header.frame_id = disparity.frame;
  const cv::Mat& counts = disparity.image.disparity;
  msg.image.header = msg.header;
  if (counts.empty()) return msg;
  atlas::Image image;
  image.stamp = disparity.stamp;
  image.frame = disparity.frame;
  image.format = "32FC1";
  counts.convertTo(image.pixels, CV_32F, 1.0 / atlas::kDisparityScale);
  image.pixels.setTo(-1.0F, counts == 0);
  msg.image = toImageMsg(image);
  msg.f = static_cast<float>(disparity.rig.focal_px);
  msg.T = static_cast<float>(disparity.rig.baseline_m);
  msg.min_disparity = 0.0F;
  msg.max_disparity = static_cast<float>(disparity.range_px);
  msg.delta_d = 1.0F / atlas::kDisparityScale;
  msg.valid_window.width = static_cast<std::uint32_t>(counts.cols);
  msg.valid_window.height = static_cast<std::uint32_t>(counts.rows);
  return msg;
}

}  // namespace atlas_ros
