// SPDX-License-Identifier: MIT
// Straight pieces of a chain of points by total least squares (after Jelinek, Zalud, Jilek 2019, "Fast total
// least squares vectorization"): sums of the chain give the best line of any piece of it at once, so pieces
// are grown as long as they are straight, and then the points between two neighbours are shared out so that
// both together fit best.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace atlas {

/// A piece of a chain: points [first, end) and the ends of its line.
struct ChainLine {
  std::size_t first = 0, end = 0;
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  double rms_m = 0;  ///< distance of the points from the line
};

/// Straight pieces of at least min_points points whose distance from their line is at most max_rms_m (root
/// mean square), in order; points of no such piece are passed over.
[[nodiscard]] std::vector<ChainLine> splitIntoLines(const std::vector<Eigen::Vector3d>& chain,
                                                    std::size_t min_points, double max_rms_m);

}  // namespace atlas
