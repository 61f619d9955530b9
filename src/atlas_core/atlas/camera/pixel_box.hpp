// SPDX-License-Identifier: MIT
// The part of an image inside a detection, for loops over points: pixels of float compared with floats, with
// the same answers as if the edges were still double.
#pragma once

#include <cmath>
#include <limits>

#include "atlas/camera/projector.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

class PixelBox {
 public:
  explicit PixelBox(const Detection2d& box)
      : left_(below(box.x_min)),
        right_(-below(-box.x_max)),
        top_(below(box.y_min)),
        bottom_(-below(-box.y_max)) {}

  /// Inside, not on the edge.
  [[nodiscard]] bool holds(const ProjectedPoint& point) const {
    return point.u > left_ && point.u < right_ && point.v > top_ && point.v < bottom_;
  }

 private:
  /// The largest float that is not above the value: a float is above the one where it is above the other.
  static float below(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) <= value
               ? nearest
               : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
  }

  float left_, right_, top_, bottom_;
};

}  // namespace atlas
