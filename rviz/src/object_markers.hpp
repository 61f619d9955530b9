// SPDX-License-Identifier: MIT
// Tracked objects as markers of RViz (compare markers.hpp): those of the local map and those of the occupancy
// grid.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include "atlas/sensor/object.hpp"

namespace atlas_rviz {

/// Per object the edges of its box in the colour of its class (pale when it stands), class, id and speed as
/// text, an arrow along its way of one second and a line through the places where it was.
visualization_msgs::MarkerArray objectMarkers(const atlas::Objects& objects);

}  // namespace atlas_rviz
