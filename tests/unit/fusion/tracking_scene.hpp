// SPDX-License-Identifier: MIT
// Boxes on wheels and what a lidar at a place sees of them, for the tests of the tracker.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "atlas/fusion/box_measurement.hpp"
#include "atlas/fusion/object_tracker.hpp"
#include "atlas/fusion/point_measurement.hpp"

namespace atlas {

struct Vehicle {
  double x = 0, y = 0, yaw = 0, length = 4.4, width = 1.8, height = 1.5;
};

/// The sides of a vehicle that face `eye`, as a box: a thin one when only one side is seen.
inline Obstacle seenPart(const Vehicle& v, const Eigen::Vector2d& eye) {
  const Eigen::Vector2d u(std::cos(v.yaw), std::sin(v.yaw)), w(-u.y(), u.x()),
      to_eye = eye - Eigen::Vector2d(v.x, v.y);
  const bool sees_end = std::abs(to_eye.dot(u)) > 0.5 * v.length,
             sees_side = std::abs(to_eye.dot(w)) > 0.5 * v.width;
  Obstacle box;
  box.yaw_rad = v.yaw;
  box.center = {v.x, v.y, 0.5 * v.height};
  box.size = {v.length, v.width, v.height};
  box.points = 100;
  const auto shrink = [&](const Eigen::Vector2d& axis, int side, double seen_m) {
    const double missing = box.size(side) - seen_m, sign = to_eye.dot(axis) > 0.0 ? 1.0 : -1.0;
    box.center.head<2>() += 0.5 * missing * sign * axis;
    box.size(side) = seen_m;
  };
  if (!sees_side) shrink(u, 0, 0.5);
  if (!sees_end) shrink(w, 1, 0.4);
  return box;
}

inline void shake(Obstacle& box, std::mt19937& random, double sigma_m) {
  std::normal_distribution<double> noise(0.0, sigma_m);
  box.center += Eigen::Vector3d(noise(random), noise(random), noise(random));
  box.size += Eigen::Vector3d(std::abs(noise(random)), std::abs(noise(random)), std::abs(noise(random)));
}

inline MeasurementPtr seenBox(const Obstacle& box, const Eigen::Vector2d& eye) {
  return std::make_unique<SeenBox>(box, Eigen::Vector3d(eye.x(), eye.y(), 1.8), SeenBox::Hidden{});
}

/// A detection of a thing of width x height by a camera at `eye`.
inline Frustum frustumOf(const Eigen::Vector3d& front, const Eigen::Vector3d& eye, double width,
                         double height, std::int32_t coco_class) {
  Frustum f;
  f.detection.class_id = coco_class;
  f.detection.confidence = 0.9;
  f.detection.y_min = 100.0;
  f.position = front;
  f.depth_sigma_m = 0.1;
  f.points = 30;
  const Eigen::Vector3d ahead = (front - eye).normalized(),
                        left = Eigen::Vector3d::UnitZ().cross(ahead).normalized();
  const Eigen::Vector3d up(0.0, 0.0, 0.5 * height), half = 0.5 * width * left;
  f.corners = {front + half + up,         front - half + up,         front - half - up,
               front + half - up,         front + half + up + ahead, front - half + up + ahead,
               front - half - up + ahead, front + half - up + ahead};
  return f;
}

constexpr Stamp kSceneStart = 1'000 * kSecond;
inline Stamp at(double t_s) { return kSceneStart + fromSeconds(t_s); }

}  // namespace atlas
