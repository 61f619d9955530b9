// SPDX-License-Identifier: MIT
// What the stages found, as markers of RViz. Pure functions: the same value gives the same markers. Each
// array begins with DELETEALL and so replaces the array before it; the stamps are those of the data.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include "atlas/sensor/lines.hpp"
#include "atlas/sensor/products.hpp"
#include "driven_path.hpp"

namespace atlas_rviz {

/// The vehicle's body in base_link.
struct VehicleBox {
  double length_m = 4.5, width_m = 1.8, height_m = 1.5;
  double center_x_m = 0.0, center_z_m = -1.0;  ///< of the body, in base_link
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const VehicleBox& box);

/// A box with its size (length x width x height) per obstacle; a box longer than a lorry (a wall, a hedge) as
/// edges only.
visualization_msgs::MarkerArray obstacleMarkers(const atlas::Obstacles& obstacles);
/// Surfaces orange, road blue, road markings white.
visualization_msgs::MarkerArray lineMarkers(const atlas::Lines& found);
/// Edges in the colour of the class; class and distance as text.
visualization_msgs::MarkerArray frustumMarkers(const atlas::Frustums& frustums);
/// The vehicle's body and its speed.
visualization_msgs::MarkerArray vehicleMarkers(const atlas::Odometry& odometry, const VehicleBox& box);
/// A line coloured by speed, blue standing to red at 20 m/s.
visualization_msgs::MarkerArray pathMarkers(const DrivenPath& path);
/// A dot per target, with a line along its bearing as long as its radial speed in one second; frame of the
/// radar.
visualization_msgs::MarkerArray radarMarkers(const atlas::RadarScan& scan);
/// Where on earth the origin of map is, as text at the origin.
visualization_msgs::MarkerArray anchorMarkers(const atlas::Anchor& anchor);

}  // namespace atlas_rviz
