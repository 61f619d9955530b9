// SPDX-License-Identifier: MIT
// How much of the skew is still in a map, as the surfaces in it tell. Leaving out the de-skew moves every
// point of a sweep by a known vector, its shift: what the car did between the moment of the point and that of
// the sweep. A surface that is seen in different phases of the sweep (first ahead, then from the side, then
// from behind) is moved by different shifts and falls apart into sheets, each where its shift puts it. At
// constant speed all sweeps are skewed alike and most of a map is as sharp with the skew as without;
// but where the sheets lie tells how much of it there is.
#pragma once

#include <cstddef>
#include <vector>

#include "atlas/lidar/map_quality.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// What is known of a point beside its place in map.
struct Skew {
  Eigen::Vector3f shift_m = Eigen::Vector3f::Zero();  ///< by which leaving out the de-skew moves it, in map
  float time_s = 0;                                   ///< of the point, since any moment of the window
};

struct SkewLeft {
  /// Least squares over all plane neighbourhoods: distance of a point from the plane = share * (its shift
  /// along the normal) + time * (drift along the normal). The planes are fitted together with it, so that a
  /// tilt explains nothing away, and the drift (one velocity for all), so that poses that drift explain
  /// nothing. 0: no skew is left. 1: all of it, nothing was de-skewed. 2: moved the wrong way round.
  double share = 0;
  std::size_t neighbourhoods =
      0;  ///< plane ones that were seen with different shifts; 0: nothing can be said
};

/// points: in map. Every params.every-th point is asked, as by mapQuality. What is not finite is left out.
/// Throws std::invalid_argument when the two have not the same length or for bad parameters.
[[nodiscard]] SkewLeft skewLeft(const std::vector<LidarPoint>& points, const std::vector<Skew>& skews,
                                const MapQualityParams& params);

}  // namespace atlas
