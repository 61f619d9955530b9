// SPDX-License-Identifier: MIT
// The distance of the object that a detection box shows. A box holds the object, what is behind it, the road
// and now and then something in front. The object is the surface that fills the middle of the box: the mode
// of the depths, weighted to the centre; its front is where that surface begins.
#pragma once

#include <vector>

#include "atlas/base/outcome.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// A lidar point seen through a box.
struct BoxPoint {
  float u = 0, v = 0;  ///< px
  float depth_m = 0;   ///< z-depth
  float time_s = 0;    ///< when it was measured, from the image on
};

struct ForegroundParams {
  double recent_s = 0.05;          ///< points nearer in time than this count alone when there are enough
  double mode_width_m = 0.6;       ///< depths that are taken together when the mode is looked for ...
  double mode_width_share = 0.01;  ///< ... plus this share of the depth
  double gap_m = 0.4;              ///< the surface ends where there is no point for so long ...
  double gap_share = 0.01;         ///< ... plus this share of the depth
  double front_quantile = 0.03;    ///< of the surface's points that may lie before its front
  int min_points = 3;
};

struct Foreground {
  double front_m = 0;  ///< z-depth where the object begins
  double back_m = 0;   ///< and where what is seen of it ends
  double sigma_m = 0;  ///< standard deviation of front_m
  std::size_t points = 0;
};

/// The result does not depend on the order of the points. kNoPoints when there are none, kLowQuality when the
/// surface has fewer than min_points.
Outcome<Foreground> findForeground(const Detection2d& box, std::vector<BoxPoint>& points,
                                   const ForegroundParams& params);

}  // namespace atlas
