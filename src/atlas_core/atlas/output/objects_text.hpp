// SPDX-License-Identifier: MIT
// Objects as CSV and as rows of the KITTI tracking benchmark.
#pragma once

#include <optional>
#include <string>

#include "atlas/sensor/object.hpp"

namespace atlas {

/// stamp_ns,id,class,probability,x,y,z,yaw,length,width,height,vx,vy,vz,static,age - class is the COCO-80
/// index as in the frustums' files, -1 = none of the known classes; m, m/s, rad, s in map.
std::string objectsCsvHeader();
/// One row per object.
std::string objectsCsvRows(const Objects& objects);

/// A camera that looks along z: x right, y down.
struct KittiCamera {
  Pose T_camera_map;
  std::optional<Eigen::Matrix<double, 3, 4>> projection;  ///< px; without it boxes in the image are -1
};
/// "Car", "Pedestrian", "Cyclist", "Van", "Truck", ... of the benchmark for a COCO-80 index; "Misc" for
/// others.
std::string kittiType(std::int32_t coco_class);
/// frame id type truncated occluded alpha x1 y1 x2 y2 h w l x y z ry score, with a line end; nothing when the
/// object is behind the camera or outside of its image.
std::optional<std::string> kittiTrackingRow(std::uint32_t frame, const Object& object,
                                            const KittiCamera& camera);

}  // namespace atlas
