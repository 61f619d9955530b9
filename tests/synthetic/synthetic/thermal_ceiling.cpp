// SPDX-License-Identifier: MIT
#include "synthetic/thermal_ceiling.hpp"

#include <algorithm>
#include <limits>

namespace atlas::synthetic {
namespace {

constexpr int kSamplesPerEdge = 8;
constexpr double kWidest = 1.4;  // tan of 54 deg: outside the thermal image, before its distortion folds back

/// Points around a box, px.
std::vector<Eigen::Vector2d> outline(const FakeDetection& box) {
  const Eigen::Vector2d corners[4] = {{box.x1, box.y1}, {box.x2, box.y1}, {box.x2, box.y2}, {box.x1, box.y2}};
  std::vector<Eigen::Vector2d> points;
  for (int edge = 0; edge < 4; ++edge) {
    const Eigen::Vector2d step = (corners[(edge + 1) % 4] - corners[edge]) / kSamplesPerEdge;
    for (int i = 0; i < kSamplesPerEdge; ++i) points.push_back(corners[edge] + i * step);
  }
  return points;
}

}  // namespace

ThermalCeiling::ThermalCeiling(const Camera& source, const Camera& thermal,
                               const std::vector<StampedPose>& truth)
    : source_(source), thermal_(thermal) {
  for (const StampedPose& pose : truth) trajectory_.push(pose);
}

std::optional<PixelBox> ThermalCeiling::boxOf(const FakeDetection& detection, double depth_m,
                                              Stamp source_stamp, Stamp thermal_stamp) const {
  const auto T_map_imu = trajectory_.at(source_stamp), T_map_imu_later = trajectory_.at(thermal_stamp);
  if (!T_map_imu || !T_map_imu_later) return std::nullopt;
  const Pose T_map_source = *T_map_imu * T_imu_sensor(source_.name);
  const Pose T_thermal_source = (*T_map_imu_later * T_imu_sensor(thermal_.name)).inverse() * T_map_source;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  PixelBox box{kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (const Eigen::Vector2d& pixel : outline(detection)) {
    const Eigen::Vector3d p = T_thermal_source * (depth_m * source_.undistort(pixel).homogeneous());
    if (p.z() <= 0.0 || p.head<2>().norm() > kWidest * p.z()) continue;
    const Eigen::Vector2d seen = thermal_.distort(p.hnormalized());
    box = {std::min(box.x1, seen.x()), std::min(box.y1, seen.y()), std::max(box.x2, seen.x()),
           std::max(box.y2, seen.y())};
  }
  box.x1 = std::max(box.x1, -0.5);
  box.y1 = std::max(box.y1, -0.5);
  box.x2 = std::min(box.x2, thermal_.width - 0.5);
  box.y2 = std::min(box.y2, thermal_.height - 0.5);
  if (!(box.x1 < box.x2) || !(box.y1 < box.y2)) return std::nullopt;
  return box;
}

}  // namespace atlas::synthetic
