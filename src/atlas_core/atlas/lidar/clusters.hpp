// SPDX-License-Identifier: MIT
// Euclidean clustering: two points belong together when a chain of points joins them with no step longer than
// the tolerance. Exact (same result as comparing all pairs), without a tree: a grid whose cells are so small
// that their own points always belong together, and a union of cells.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// Point indices of each cluster, ascending; clusters ordered by their smallest index. Points that are not
/// finite are in none. tolerance_m > 0, else std::invalid_argument; a distance of exactly the tolerance
/// joins.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> euclideanClusters(const std::vector<LidarPoint>& points,
                                                                        double tolerance_m);

}  // namespace atlas
