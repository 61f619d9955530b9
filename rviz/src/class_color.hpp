// SPDX-License-Identifier: MIT
// The six groups of COCO classes that matter on a road, and the colour of each: the same as in the published
// Atlas Fusion (red pedestrian, purple bike, blue vehicle, green animal, aqua traffic, yellow other).
#pragma once

#include <std_msgs/ColorRGBA.h>

namespace atlas_rviz {

enum class ClassGroup { kPedestrian, kBike, kVehicle, kAnimal, kTraffic, kOther };

/// Group of a COCO-80 index; kOther for every class that is none of the road and for unknown numbers.
ClassGroup classGroup(int class_id);
/// Opaque.
std_msgs::ColorRGBA groupColor(ClassGroup group);

}  // namespace atlas_rviz
