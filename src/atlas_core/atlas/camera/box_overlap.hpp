// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// Intersection over union of two boxes, 0 when they do not touch.
inline double overlapOf(const Detection2d& a, const Detection2d& b) {
  const double width = std::min(a.x_max, b.x_max) - std::max(a.x_min, b.x_min);
  const double height = std::min(a.y_max, b.y_max) - std::max(a.y_min, b.y_min);
  if (width <= 0.0 || height <= 0.0) return 0.0;
  const auto area = [](const Detection2d& box) { return (box.x_max - box.x_min) * (box.y_max - box.y_min); };
  return width * height / (area(a) + area(b) - width * height);
}

}  // namespace atlas
