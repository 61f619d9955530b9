// SPDX-License-Identifier: MIT
// Pieces that all markers are made of. A MarkerArray begins with DELETEALL, so that it replaces the one
// before it on its topic; every marker carries the stamp of the data it shows.
#pragma once

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <array>
#include <string>

#include "atlas/base/geometry.hpp"
#include "atlas/base/time.hpp"

namespace atlas_rviz {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// Channels and opacity, 0..1.
std_msgs::ColorRGBA color(double red, double green, double blue, double alpha = 1.0);
geometry_msgs::Point point(const Eigen::Vector3d& p);

/// What the markers of one message have in common.
struct MarkerOrigin {
  atlas::Stamp stamp = 0;
  std::string frame = "map";
};

/// Only the marker that deletes what the topic showed before.
MarkerArray emptyArray(const MarkerOrigin& origin);
/// A marker to add, with pose identity. `type`: a constant of visualization_msgs/Marker.
Marker marker(const MarkerOrigin& origin, const std::string& ns, int id, int type);
/// Text that faces the viewer, letters of height_m, around p (m, frame of origin).
Marker textMarker(const MarkerOrigin& origin, int id, const Eigen::Vector3d& p, const std::string& text,
                  double height_m, const std_msgs::ColorRGBA& text_color);

/// Eight corners of a box or frustum: one face (around), then the opposite face in the same order.
using Corners = std::array<Eigen::Vector3d, 8>;
/// Corners of a box of the given size (m) around the origin of T_map_box.
Corners boxCorners(const atlas::Pose& T_map_box, const Eigen::Vector3d& size);
/// Adds the twelve edges to a LINE_LIST with one colour per point.
void addEdges(Marker& line_list, const Corners& corners, const std_msgs::ColorRGBA& edge_color);

}  // namespace atlas_rviz
