// SPDX-License-Identifier: MIT
// A box seen from above and the overlap of two of them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace atlas::synthetic {

struct PlanBox {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< m
  double yaw_rad = 0, length = 0, width = 0;         ///< length along yaw
  double bottom = 0, top = 0;                        ///< m, heights

  /// (along, across) of a point from the centre.
  [[nodiscard]] Eigen::Vector2d local(const Eigen::Vector2d& p) const {
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    const Eigen::Vector2d d = p - center;
    return {c * d.x() + s * d.y(), -s * d.x() + c * d.y()};
  }
  [[nodiscard]] bool holds(const Eigen::Vector2d& p, double margin_m) const {
    const Eigen::Vector2d d = local(p);
    return std::abs(d.x()) <= 0.5 * length + margin_m && std::abs(d.y()) <= 0.5 * width + margin_m;
  }
  [[nodiscard]] std::vector<Eigen::Vector2d> corners() const {
    const Eigen::Vector2d along(0.5 * length * std::cos(yaw_rad), 0.5 * length * std::sin(yaw_rad));
    const Eigen::Vector2d across(-0.5 * width * std::sin(yaw_rad), 0.5 * width * std::cos(yaw_rad));
    return {center + along + across, center - along + across, center - along - across,
            center + along - across};
  }
};

/// Area of a polygon whose corners go round counter-clockwise.
inline double areaOf(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

/// Area that both cover (Sutherland and Hodgman 1974: a's polygon cut by the sides of b).
inline double sharedArea(const PlanBox& a, const PlanBox& b) {
  std::vector<Eigen::Vector2d> polygon = a.corners();
  const std::vector<Eigen::Vector2d> sides = b.corners();
  for (std::size_t k = 0; k < sides.size() && !polygon.empty(); ++k) {
    const Eigen::Vector2d from = sides[k], along = sides[(k + 1) % sides.size()] - from;
    const auto inside = [&](const Eigen::Vector2d& p) {
      return along.x() * (p.y() - from.y()) - along.y() * (p.x() - from.x());
    };
    std::vector<Eigen::Vector2d> cut;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double at_p = inside(p), at_q = inside(q);
      if (at_p >= 0.0) cut.push_back(p);
      if ((at_p >= 0.0) != (at_q >= 0.0)) cut.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
    polygon = std::move(cut);
  }
  return std::max(0.0, areaOf(polygon));
}

/// Intersection over union of the areas.
inline double overlapOfAreas(const PlanBox& a, const PlanBox& b) {
  const double both = sharedArea(a, b);
  const double either = a.length * a.width + b.length * b.width - both;
  return either > 0.0 ? both / either : 0.0;
}

}  // namespace atlas::synthetic
