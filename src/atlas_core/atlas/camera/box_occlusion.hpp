// SPDX-License-Identifier: MIT
// Is an object whose place is known hidden in the view of a camera? The lidar points that this camera sees
// through the object's box are looked at cell by cell: where the nearest one lies clearly before the object,
// something else is seen there.
#pragma once

#include <array>
#include <optional>

#include "atlas/camera/projector.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct OcclusionParams {
  double least_step_m = 1.0;  ///< points before the object by this ...
  double step_share = 0.03;   ///< ... plus this share of its depth belong to something else
  int least_cells = 4;        ///< with points; fewer say nothing
};

class BoxOcclusion {
 public:
  /// `box` lies in the image, `front_m` is the z-depth of the front of the object.
  BoxOcclusion(const Detection2d& box, double front_m, const OcclusionParams& params);
  /// A point of the image; outside the box it does not count. The order of points has no influence.
  void add(const ProjectedPoint& point);
  /// Share of the cells with points in which something nearer is seen; nullopt when too few have any.
  [[nodiscard]] std::optional<double> hiddenShare() const;

 private:
  static constexpr int kSide = 8;  ///< cells along a side
  Detection2d box_;
  float limit_m_;
  int least_cells_;
  std::array<float, kSide * kSide> nearest_m_;
};

}  // namespace atlas
