// SPDX-License-Identifier: MIT
// How sharp a map is, without knowing the truth: a wall that was put together from wrong poses or wrong times
// is thicker than the noise of the sensor.
#pragma once

#include <cstddef>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct MapQualityParams {
  double radius_m = 0.3;            ///< of the neighbourhood of a point
  std::size_t min_neighbours = 12;  ///< fewer say nothing about a surface
  std::size_t every = 1;            ///< asks every n-th point only; all points are neighbours
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const MapQualityParams& params);

struct MapQuality {
  /// Mean of ln(det(2 pi e S)) / 2 over the covariances S of neighbourhoods (Droeschel, Behnke 2014; Razlaw
  /// et al. 2015), with (1 mm)^2 added to S: points on one line would have none. Lower is sharper.
  double mean_entropy = 0;
  /// Root mean square distance to the plane of the neighbourhood, median over the plane ones. On a plane with
  /// normal noise it is that noise.
  double plane_thickness_m = 0;
  std::size_t neighbourhoods = 0;  ///< that the entropy was taken over; 0: nothing could be said
  std::size_t planes = 0;          ///< of these, plane
};

/// The same points in the same order give the same numbers. Points that are not finite are left out; they
/// count when every n-th is asked, so two versions of a cloud are asked at the same points.
[[nodiscard]] MapQuality mapQuality(const std::vector<LidarPoint>& points, const MapQualityParams& params);

}  // namespace atlas
