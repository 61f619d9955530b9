// SPDX-License-Identifier: MIT
// A cluster that several objects claim, shared out among them: K-means with as many means as there are
// objects, begun at their predicted states (Bishop 2006, "Pattern Recognition and Machine Learning", 9.1).
#pragma once

#include <vector>

#include "atlas/grid/cell_clusters.hpp"

namespace atlas {

/// Index into `seeds` (x, y, vx, vy) of each cell; ties go to the lower one. A seed may end without cells.
[[nodiscard]] std::vector<std::size_t> shareOut(const Cluster& cells, std::vector<Eigen::Vector4d> seeds);

}  // namespace atlas
