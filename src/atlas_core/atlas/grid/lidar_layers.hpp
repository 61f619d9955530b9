// SPDX-License-Identifier: MIT
// A few layers of a 3D lidar, as the four layers of the paper's lidars: which of its lasers are looked at,
// and what they measured, seen from above.
#pragma once

#include <vector>

#include "atlas/sensor/products.hpp"

namespace atlas {

struct LayerParams {
  /// Elevations of the layers in the lidar's frame; the laser nearest to each is taken, each laser once.
  /// Empty: `count` lasers about `spacing_rad` apart around `middle_rad`.
  std::vector<double> elevations_rad;
  int count = 4;
  double spacing_rad = 0.8 * 0.017453292519943295;
  double middle_rad = -0.4 * 0.017453292519943295;
  double max_miss_rad = 1.0 * 0.017453292519943295;  ///< no laser nearer to an asked elevation: no such layer
};
void validate(const LayerParams& params);

/// One measurement of a layer. Azimuth about the z axis of map, range along the ground, both from the
/// lidar's place at the sweep's stamp.
struct LayerBeam {
  float azimuth_rad = 0;  ///< (-pi, pi]
  float range_m = 0;      ///< NaN: it went out and nothing came back
  float height_m = 0;     ///< z of the return in map, NaN without one
};
struct LidarLayer {
  double elevation_rad = 0;
  std::vector<LayerBeam> beams;  ///< in the order they were measured
};
struct LidarLayers {
  Stamp stamp = 0;
  Pose T_map_lidar;  ///< at `stamp`
  std::vector<LidarLayer> layers;
};

/// The layers of a sweep, lowest first. A run of points without return between two returns of the same laser
/// is spread evenly between their azimuths; at the ends of a laser's points nothing is known of them. Empty
[[nodiscard]] LidarLayers pickLayers(const BatchedSweep& batched, const LayerParams& params);

}  // namespace atlas
