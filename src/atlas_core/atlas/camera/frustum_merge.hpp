// SPDX-License-Identifier: MIT
// The fields of view of the cameras overlap, so one object can be seen by two: it becomes one frustum.
#pragma once

#include <vector>

#include "atlas/sensor/products.hpp"

namespace atlas {

struct FrustumMergeParams {
  double largest_distance_m = 1.0;  ///< between the places of one object by two cameras ...
  double sigmas = 3.0;              ///< ... plus so many standard deviations of both distances
};

/// The frustums of images taken at one time by different cameras, duplicates removed: of two of one class at
/// one place in map, seen by different cameras, the one with more lidar points stays (a box that is cut by
/// the border of its image has fewer), of equal ones that of the earlier camera in `images`. Stamp and index
/// are those of the first image, camera is empty.
Frustums mergeDuplicates(const std::vector<Frustums>& images, const FrustumMergeParams& params);

}  // namespace atlas
