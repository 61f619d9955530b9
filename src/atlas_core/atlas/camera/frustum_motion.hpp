// SPDX-License-Identifier: MIT
// What the images before and after an image of the same camera tell about the objects in it: how they move,
// and which of them its detector has missed. An object is known again by its class and its place in map.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "atlas/sensor/products.hpp"

namespace atlas {

struct FrustumMotionParams {
  double largest_speed_mps = 40.0;  ///< faster is not the same object
  double place_noise_m = 1.0;  ///< by which places of a standing object differ: a shorter way is no motion
  double most_overlap = 0.3;   ///< intersection over union with a box of the image: not missed after all
  double bridged_confidence = 0.5;  ///< of a missed object, as share of the smaller one of its neighbours
};
void validate(const FrustumMotionParams& params);

struct MovingFrustum {
  Frustum frustum;                                             ///< at the stamp of its image
  std::uint32_t index = 0;                                     ///< in the Frustums of its image, or kBridged
  Eigen::Vector3d velocity_map_mps = Eigen::Vector3d::Zero();  ///< zero when not known
};
/// Index of an object that the image does not have: it is between where it was and where it will be.
constexpr std::uint32_t kBridged = std::numeric_limits<std::uint32_t>::max();

/// The frustums of `image` in order, then the bridged ones: those that `before` and `after` have and it has
/// not. Either neighbour may be null; stamps grow.
std::vector<MovingFrustum> followObjects(const Frustums* before, const Frustums& image, const Frustums* after,
                                         const FrustumMotionParams& params);

/// Where it is `seconds` later.
Frustum moved(const MovingFrustum& object, double seconds);

}  // namespace atlas
