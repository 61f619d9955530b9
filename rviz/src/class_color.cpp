// SPDX-License-Identifier: MIT
#include "class_color.hpp"

#include "marker_shapes.hpp"

namespace atlas_rviz {

ClassGroup classGroup(int class_id) {
  switch (class_id) {
    case 0:  // person
      return ClassGroup::kPedestrian;
    case 1:  // bicycle
    case 3:  // motorcycle
      return ClassGroup::kBike;
    case 2:  // car
    case 5:  // bus
    case 6:  // train
    case 7:  // truck
    case 8:  // boat
      return ClassGroup::kVehicle;
    case 9:   // traffic light
    case 11:  // stop sign
      return ClassGroup::kTraffic;
    default:
      return class_id >= 14 && class_id <= 23 ? ClassGroup::kAnimal : ClassGroup::kOther;  // bird ... giraffe
  }
}

std_msgs::ColorRGBA groupColor(ClassGroup group) {
  switch (group) {
    case ClassGroup::kPedestrian:
      return color(1.0, 0.0, 0.0);
    case ClassGroup::kBike:
      return color(0.6, 0.1, 0.9);
    case ClassGroup::kVehicle:
      return color(0.1, 0.3, 1.0);
    case ClassGroup::kAnimal:
      return color(0.0, 0.8, 0.0);
    case ClassGroup::kTraffic:
      return color(0.0, 1.0, 1.0);
    case ClassGroup::kOther:
      break;
  }
  return color(1.0, 1.0, 0.0);
}

}  // namespace atlas_rviz
