// SPDX-License-Identifier: MIT
#include "markers.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/output/coco_names.hpp"
#include "atlas/output/fixed_text.hpp"
#include "atlas_ros/conversions.hpp"
#include "class_color.hpp"
#include "marker_shapes.hpp"

namespace atlas_rviz {
namespace {

using atlas::fixedText;

constexpr double kLineWidth = 0.08;     // m
constexpr double kFrustumWidth = 0.12;  // m, of lines that are to be seen first
constexpr double kTextHeight = 0.7;     // m, readable from behind the vehicle
constexpr double kSmallText = 0.4;      // m, for what is read only when one looks closer
constexpr double kTextGap = 0.4;        // m, between an obstacle and the middle of its text
constexpr double kHighText = 1.1;       // m, the same for texts that shall not cover those of the obstacles
constexpr double kLongestSolid = 13.0;  // m; a lorry is 12 m long
constexpr double kRedSpeed = 20.0;      // m/s

/// RViz refuses a whole marker for one bad number in it.
bool finite(const atlas::Obstacle& obstacle) {
  return obstacle.center.allFinite() && obstacle.size.allFinite() && std::isfinite(obstacle.yaw_rad);
}
bool finite(const atlas::Frustum& frustum) {
  return std::all_of(frustum.corners.begin(), frustum.corners.end(),
                     [](const auto& p) { return p.allFinite(); });
}

Marker lines(const MarkerOrigin& origin, const std::string& ns, int type, double width_m) {
  Marker result = marker(origin, ns, 0, type);
  result.scale.x = width_m;
  result.color = color(1, 1, 1);  // RViz wants an alpha even where every point has its colour
  return result;
}

/// Blue through green to red for 0 .. 1.
std_msgs::ColorRGBA rampColor(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return color(std::max(0.0, 2 * s - 1), 1 - std::abs(2 * s - 1), std::max(0.0, 1 - 2 * s));
}

/// Half way to white: letters in pure blue or red cannot be read on a dark ground.
std_msgs::ColorRGBA paler(const std_msgs::ColorRGBA& c) {
  return color(0.5 + 0.5 * c.r, 0.5 + 0.5 * c.g, 0.5 + 0.5 * c.b, c.a);
}

Marker solidBox(const MarkerOrigin& origin, const std::string& ns, int id, const atlas::Pose& T_map_box,
                const Eigen::Vector3d& size) {
  Marker box = marker(origin, ns, id, Marker::CUBE);
  box.pose = atlas_ros::toMsg(T_map_box);
  box.scale.x = size.x();
  box.scale.y = size.y();
  box.scale.z = size.z();
  return box;
}

}  // namespace

void validate(const VehicleBox& box) {
  const auto positive = [](const char* field, double value) {
    if (std::isfinite(value) && value > 0) return;
    throw std::invalid_argument(std::string(field) + " must be positive, got " + std::to_string(value));
  };
  positive("vehicle_length_m", box.length_m);
  positive("vehicle_width_m", box.width_m);
  positive("vehicle_height_m", box.height_m);
}

MarkerArray obstacleMarkers(const atlas::Obstacles& obstacles) {
  const MarkerOrigin origin{obstacles.stamp};
  MarkerArray array = emptyArray(origin);
  Marker edges = lines(origin, "edges", Marker::LINE_LIST, kLineWidth);
  int id = 0;
  for (const atlas::Obstacle& obstacle : obstacles.obstacles) {
    if (!finite(obstacle)) continue;
    const Eigen::Quaterniond R_map_box(Eigen::AngleAxisd(obstacle.yaw_rad, Eigen::Vector3d::UnitZ()));
    const atlas::Pose T_map_box{R_map_box, obstacle.center};
    const Eigen::Vector3d size = obstacle.size.cwiseMax(0.05);  // m: a flat box would not be seen
    const bool solid = std::max(size.x(), size.y()) <= kLongestSolid;
    addEdges(edges, boxCorners(T_map_box, size), solid ? color(1.0, 0.6, 0.1) : color(0.6, 0.6, 0.6));
    if (!solid) continue;
    array.markers.push_back(solidBox(origin, "boxes", id, T_map_box, size));
    array.markers.back().color = color(1.0, 0.55, 0.1, 0.35);
    const Eigen::Vector3d above = obstacle.center + Eigen::Vector3d(0, 0, 0.5 * size.z() + kTextGap);
    const std::string text =
        fixedText(size.x(), 1) + " x " + fixedText(size.y(), 1) + " x " + fixedText(size.z(), 1) + " m";
    array.markers.push_back(textMarker(origin, id, above, text, kSmallText, color(1.0, 0.85, 0.6)));
    ++id;
  }
  if (!edges.points.empty()) array.markers.push_back(edges);
  return array;
}

MarkerArray lineMarkers(const atlas::Lines& found) {
  const std_msgs::ColorRGBA colors[] = {color(1.0, 0.6, 0.1), color(0.3, 0.5, 1.0), color(1, 1, 1)};
  const MarkerOrigin origin{found.stamp};
  MarkerArray array = emptyArray(origin);
  Marker list = lines(origin, "lines", Marker::LINE_LIST, kLineWidth);
  for (const atlas::Line& line : found.lines) {
    if (!line.from.allFinite() || !line.to.allFinite()) continue;
    list.points.push_back(point(line.from));
    list.points.push_back(point(line.to));
    list.colors.insert(list.colors.end(), 2, colors[static_cast<std::size_t>(line.kind)]);
  }
  if (!list.points.empty()) array.markers.push_back(list);
  return array;
}

MarkerArray frustumMarkers(const atlas::Frustums& frustums) {
  const MarkerOrigin origin{frustums.stamp};
  MarkerArray array = emptyArray(origin);
  Marker edges = lines(origin, "edges", Marker::LINE_LIST, kFrustumWidth);
  int id = 0;
  for (const atlas::Frustum& frustum : frustums.frustums) {
    if (!finite(frustum)) continue;
    const std_msgs::ColorRGBA class_color = groupColor(classGroup(frustum.detection.class_id));
    addEdges(edges, frustum.corners, class_color);
    const Eigen::Vector3d top = 0.5 * (frustum.corners[0] + frustum.corners[1]);
    const std::string text =
        atlas::className(frustum.detection.class_id) + " " + fixedText(frustum.distance_m, 1) + " m";
    array.markers.push_back(textMarker(origin, id, top + Eigen::Vector3d(0, 0, kHighText), text, kTextHeight,
                                       paler(class_color)));
    ++id;
  }
  if (!edges.points.empty()) array.markers.push_back(edges);
  return array;
}

MarkerArray vehicleMarkers(const atlas::Odometry& odometry, const VehicleBox& box) {
  const MarkerOrigin origin{odometry.stamp};
  MarkerArray array = emptyArray(origin);
  const atlas::Pose T_imu_body{Eigen::Quaterniond::Identity(), {box.center_x_m, 0.0, box.center_z_m}};
  const atlas::Pose T_map_body = odometry.T_map_imu * T_imu_body;
  const Eigen::Vector3d size(box.length_m, box.width_m, box.height_m);
  array.markers.push_back(solidBox(origin, "body", 0, T_map_body, size));
  array.markers.back().color = color(0.85, 0.85, 0.9, 0.6);
  Marker edges = lines(origin, "edges", Marker::LINE_LIST, 0.5 * kLineWidth);
  addEdges(edges, boxCorners(T_map_body, size), color(1, 1, 1));
  array.markers.push_back(edges);
  const double speed_mps = odometry.velocity_imu_mps.norm();
  const std::string text = fixedText(speed_mps, 1) + " m/s, " + fixedText(3.6 * speed_mps, 0) + " km/h";
  const Eigen::Vector3d above = T_map_body * Eigen::Vector3d(0, 0, 0.5 * size.z() + kHighText);
  array.markers.push_back(textMarker(origin, 0, above, text, kTextHeight, color(1, 1, 1)));
  return array;
}

MarkerArray pathMarkers(const DrivenPath& path) {
  const MarkerOrigin origin{path.stamp()};
  MarkerArray array = emptyArray(origin);
  if (path.points().size() < 2) return array;  // RViz wants two points for a line
  Marker line = lines(origin, "path", Marker::LINE_STRIP, 0.3);
  for (const DrivenPath::Point& p : path.points()) {
    line.points.push_back(point(p.position));
    line.colors.push_back(rampColor(p.speed_mps / kRedSpeed));
  }
  array.markers.push_back(line);
  return array;
}

MarkerArray radarMarkers(const atlas::RadarScan& scan) {
  const MarkerOrigin origin{scan.stamp, scan.frame};
  MarkerArray array = emptyArray(origin);
  Marker dots = marker(origin, "targets", 0, Marker::SPHERE_LIST);
  dots.scale.x = dots.scale.y = dots.scale.z = 0.4;
  dots.color = color(1.0, 0.2, 1.0);
  Marker speeds = lines(origin, "speeds", Marker::LINE_LIST, kLineWidth);
  for (const atlas::RadarTarget& target : scan.targets) {
    if (!target.position.allFinite() || !std::isfinite(target.radial_velocity_mps)) continue;
    dots.points.push_back(point(target.position));
    const Eigen::Vector3d along = target.radial_velocity_mps * target.position.normalized();
    for (const Eigen::Vector3d& p : {target.position, Eigen::Vector3d(target.position + along)}) {
      speeds.points.push_back(point(p));
      speeds.colors.push_back(dots.color);
    }
  }
  if (dots.points.empty()) return array;
  array.markers.push_back(dots);
  array.markers.push_back(speeds);
  return array;
}

MarkerArray anchorMarkers(const atlas::Anchor& anchor) {
  const MarkerOrigin origin{anchor.stamp};
  MarkerArray array = emptyArray(origin);
  const std::string text = "map: " + fixedText(anchor.position.latitude_deg, 6) + " deg N, " +
                           fixedText(anchor.position.longitude_deg, 6) + " deg E, " +
                           fixedText(anchor.position.altitude_m, 1) + " m";
  array.markers.push_back(
      textMarker(origin, 0, Eigen::Vector3d::Zero(), text, kSmallText, color(0.7, 0.7, 0.7)));
  return array;
}

}  // namespace atlas_rviz
