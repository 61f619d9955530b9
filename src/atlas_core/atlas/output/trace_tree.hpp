// SPDX-License-Identifier: MIT
// The tree from a product down to the raw data it was made from. What a run wrote (origins_csv.hpp) is looked
// up; what holds for every run is known here:
//   <lidar>/batches     the sweep of the same stamp and index in <lidar>/points, placed by odometry
//   <camera>/detections made from the picture of the same stamp and index
//   obstacles           batches of the first lidar with the same stamp, the newest ones of the others
//   odometry            interpolated between the imu/data around; by the filter's memory all data before
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "atlas/sensor/products.hpp"

namespace atlas {

/// Finds the rows of several products at once: for each of `wanted` the one with its topic and stamp;
/// products without a row are not in the answer.
using FindOrigins = std::function<std::vector<ProductOrigins>(const std::vector<Origin>& wanted)>;

/// Text of the tree, one origin a line, indented by depth. `root` need not have a row: it is told then.
std::string traceTree(const Origin& root, const FindOrigins& find);

}  // namespace atlas
