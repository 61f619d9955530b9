// SPDX-License-Identifier: MIT
#include "marker_shapes.hpp"

#include "atlas_ros/conversions.hpp"

namespace atlas_rviz {

std_msgs::ColorRGBA color(double red, double green, double blue, double alpha) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(red);
  result.g = static_cast<float>(green);
  result.b = static_cast<float>(blue);
  result.a = static_cast<float>(alpha);
  return result;
}

geometry_msgs::Point point(const Eigen::Vector3d& p) {
  geometry_msgs::Point result;
  result.x = p.x();
  result.y = p.y();
  result.z = p.z();
  return result;
}

MarkerArray emptyArray(const MarkerOrigin& origin) {
  Marker all = marker(origin, "", 0, Marker::CUBE);
  all.action = Marker::DELETEALL;
  MarkerArray array;
  array.markers.push_back(all);
  return array;
}

Marker marker(const MarkerOrigin& origin, const std::string& ns, int id, int type) {
  Marker result;
  result.header.stamp = atlas_ros::toTime(origin.stamp);
  result.header.frame_id = origin.frame;
  result.ns = ns;
  result.id = id;
  result.type = type;
  result.action = Marker::ADD;
  result.pose.orientation.w = 1.0;
  return result;
}

Marker textMarker(const MarkerOrigin& origin, int id, const Eigen::Vector3d& p, const std::string& text,
                  double height_m, const std_msgs::ColorRGBA& text_color) {
  Marker result = marker(origin, "text", id, Marker::TEXT_VIEW_FACING);
  result.pose.position = point(p);
  result.text = text;
  result.scale.z = height_m;
  result.color = text_color;
  return result;
}

Corners boxCorners(const atlas::Pose& T_map_box, const Eigen::Vector3d& size) {
  Corners corners;
  const Eigen::Vector3d half = 0.5 * size;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double x = i % 4 == 0 || i % 4 == 3 ? half.x() : -half.x();
    const double y = i % 4 < 2 ? half.y() : -half.y();
    corners[i] = T_map_box * Eigen::Vector3d(x, y, i < 4 ? -half.z() : half.z());
  }
  return corners;
}

void addEdges(Marker& line_list, const Corners& corners, const std_msgs::ColorRGBA& edge_color) {
  const auto edge = [&](std::size_t from, std::size_t to) {
    for (const std::size_t corner : {from, to}) {
      line_list.points.push_back(point(corners[corner]));
      line_list.colors.push_back(edge_color);
    }
  };
  for (std::size_t i = 0; i < 4; ++i) {
    edge(i, (i + 1) % 4);
    edge(4 + i, 4 + (i + 1) % 4);
    edge(i, 4 + i);
  }
}

}  // namespace atlas_rviz
