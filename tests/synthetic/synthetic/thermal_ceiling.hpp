// SPDX-License-Identifier: MIT
// The best label that a detection can become: its box at the true depth of the object, moved into the thermal
// image by the true poses and the exact camera models. What is missing to the true box then is the
// detection's own noise, the depth of the object, and its motion between the two images.
#pragma once

#include <optional>
#include <vector>

#include "atlas/base/trajectory.hpp"
#include "synthetic/boxes2d.hpp"
#include "synthetic/rig.hpp"

namespace atlas::synthetic {

struct SourceImage {
  Stamp stamp = 0;
  std::vector<FakeDetection> detections;
};

struct PixelBox {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
};

class ThermalCeiling {
 public:
  ThermalCeiling(const Camera& source, const Camera& thermal, const std::vector<StampedPose>& truth);
  /// Clipped to the thermal image; nothing when no part is in it or a stamp lies outside the trajectory.
  [[nodiscard]] std::optional<PixelBox> boxOf(const FakeDetection& detection, double depth_m,
                                              Stamp source_stamp, Stamp thermal_stamp) const;

 private:
  Camera source_, thermal_;
  Trajectory trajectory_;
};

}  // namespace atlas::synthetic
