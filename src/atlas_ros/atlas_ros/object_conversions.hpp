// SPDX-License-Identifier: MIT
// Objects and the local map as messages (compare conversions.hpp).
#pragma once

#include <atlas_msgs/LocalMap.h>
#include <atlas_msgs/ObjectArray.h>

#include "atlas/fusion/local_map.hpp"
#include "atlas_ros/conversions.hpp"

namespace atlas_ros {

atlas_msgs::ObjectArray toMsg(const atlas::Objects& objects);
atlas::Outcome<atlas::ObjectsPtr> fromMsg(const atlas_msgs::ObjectArray& msg);
atlas_msgs::LocalMap toMsg(const atlas::LocalMapView& view);

}  // namespace atlas_ros
