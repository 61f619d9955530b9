// SPDX-License-Identifier: MIT
#include "atlas/output/objects_text.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/output/fixed_text.hpp"

namespace atlas {
namespace {

constexpr double kNearest_m = 0.5;  ///< parts nearer to the image plane are not projected

struct ImageBox {
  double x1 = 1e9, y1 = 1e9, x2 = -1e9, y2 = -1e9;
};

/// Outline of the box's corners that lie before the camera, cut to the image; nothing when none is left.
std::optional<ImageBox> outline(const Eigen::Matrix<double, 3, 8>& corners,
                                const Eigen::Matrix<double, 3, 4>& P) {
  ImageBox box;
  for (int i = 0; i < 8; ++i) {
    Eigen::Vector3d p = corners.col(i);
    p.z() = std::max(p.z(), kNearest_m);
    const Eigen::Vector3d q = P * p.homogeneous();
    box.x1 = std::min(box.x1, q.x() / q.z());
    box.x2 = std::max(box.x2, q.x() / q.z());
    box.y1 = std::min(box.y1, q.y() / q.z());
    box.y2 = std::max(box.y2, q.y() / q.z());
  }
  const double width = 2.0 * P(0, 2), height = 2.0 * P(1, 2);  // the centre of the image is the camera's
  box.x1 = std::clamp(box.x1, 0.0, width - 1.0);
  box.x2 = std::clamp(box.x2, 0.0, width - 1.0);
  box.y1 = std::clamp(box.y1, 0.0, height - 1.0);
  box.y2 = std::clamp(box.y2, 0.0, height - 1.0);
  if (box.x2 - box.x1 < 1.0 || box.y2 - box.y1 < 1.0) return std::nullopt;
  return box;
}

Eigen::Matrix<double, 3, 8> cornersOf(const Object& object, const Pose& T_camera_map) {
  Eigen::Matrix<double, 3, 8> corners;
  const Eigen::AngleAxisd turn(object.yaw_rad, Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d part(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    corners.col(i) = T_camera_map * (object.position + turn * part.cwiseProduct(object.size));
  }
  return corners;
}

}  // namespace

std::string objectsCsvHeader() {
  return "stamp_ns,id,class,probability,x,y,z,yaw,length,width,height,vx,vy,vz,static,age\n";
}

std::string objectsCsvRows(const Objects& objects) {
  std::string text;
  for (const Object& o : objects.objects) {
    text += std::to_string(objects.stamp) + "," + std::to_string(o.id) + "," + std::to_string(o.class_id) +
            "," + fixedText(o.class_probability, 4);
    for (const double value :
         {o.position.x(), o.position.y(), o.position.z(), o.yaw_rad, o.size.x(), o.size.y(), o.size.z(),
          o.velocity_mps.x(), o.velocity_mps.y(), o.velocity_mps.z()})
      text += "," + fixedText(value, 4);
    text += std::string(o.is_static ? ",1," : ",0,") + fixedText(o.age_s, 3) + "\n";
  }
  return text;
}

std::string kittiType(std::int32_t coco_class) {
  switch (coco_class) {
    case 0:
      return "Pedestrian";
    case 1:
    case 3:
      return "Cyclist";
    case 2:
      return "Car";
    case 5:
    case 7:
      return "Truck";
    case 6:
      return "Tram";
    default:
      return "Misc";
  }
}

std::optional<std::string> kittiTrackingRow(std::uint32_t frame, const Object& object,
                                            const KittiCamera& camera) {
  const Eigen::Vector3d half_up(0.0, 0.0, 0.5 * object.size.z());
  const Eigen::Vector3d bottom = camera.T_camera_map * (object.position - half_up);
  ImageBox box{-1.0, -1.0, -1.0, -1.0};
  if (camera.projection) {
    if (bottom.z() < kNearest_m) return std::nullopt;
    const auto seen = outline(cornersOf(object, camera.T_camera_map), *camera.projection);
    if (!seen) return std::nullopt;
    box = *seen;
  }
  const Eigen::Vector3d forward =
      camera.T_camera_map.rotation * Eigen::Vector3d(std::cos(object.yaw_rad), std::sin(object.yaw_rad), 0.0);
  const double rotation_y = std::atan2(-forward.z(), forward.x());
  const double alpha = wrapAngle(rotation_y - std::atan2(bottom.x(), bottom.z()));
  std::string row =
      std::to_string(frame) + " " + std::to_string(object.id) + " " + kittiType(object.class_id) + " 0 0";
  for (const double value : {alpha, box.x1, box.y1, box.x2, box.y2, object.size.z(), object.size.y(),
                             object.size.x(), bottom.x(), bottom.y(), bottom.z(), rotation_y, object.score})
    row += " " + fixedText(value, 6);
  return row + "\n";
}

}  // namespace atlas
