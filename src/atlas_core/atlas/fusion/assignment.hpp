// SPDX-License-Identifier: MIT
// Optimal assignment of few rows to many columns over a sparse list of allowed pairs: shortest augmenting
// paths (Jonker and Volgenant 1987, "A shortest augmenting path algorithm for dense and sparse linear
// assignment problems"), each path searched within the connected component that it touches. A row may stay
// without a column.
#pragma once

#include <cstdint>
#include <vector>

namespace atlas {

struct AssignmentEdge {
  std::uint32_t column = 0;
  double cost = 0.0;
};
constexpr int kUnassigned = -1;

/// Column of each row, or kUnassigned, so that the sum of the costs is least when a row without a column
/// costs `cost_of_none`; edges that cost as much or more are of no use. The result is a function of the
/// numbers: of equal sums the one that the order of rows and edges comes upon first. Costs must be finite.
[[nodiscard]] std::vector<int> assign(const std::vector<std::vector<AssignmentEdge>>& edges_of_row,
                                      std::size_t columns, double cost_of_none);

}  // namespace atlas
