// SPDX-License-Identifier: MIT
// One opinion of a cell out of several sensors' (Paromtchik, Perrollaz, Laugier 2011, eq. (2), and its
// alternatives for sensors that contradict each other). p_i = P(occupied | Z_i) under the prior 1/2, so
// P(Z_i | occupied) : P(Z_i | empty) = p_i : 1 - p_i, whatever the velocity.
#pragma once

#include <vector>

namespace atlas {

enum class Pooling {
  kProduct,  ///< eq. (2): odds multiply; sensors must be independent
  kLog,      ///< weighted geometric mean of the odds: no surer than the surest sensor
  kLinear    ///< weighted mean of the probabilities (Adarve, Perrollaz, Makris, Laugier 2012)
};

/// Takes the sensors' grids one by one. In the pools a sensor's weight is how much it says, |2 p - 1|: one
/// that knows nothing of a cell has no part in it.
class PooledGrid {
 public:
  explicit PooledGrid(Pooling pooling) : pooling_(pooling) {}
  void reset(std::size_t cells);
  void add(const std::vector<float>& occupied);
  /// P(occupied) of each cell in [0.02, 0.98]; 0.5 where nobody said anything.
  const std::vector<float>& result();

 private:
  Pooling pooling_;
  std::vector<float> numerator_, weight_;
  std::vector<float> pooled_;
};

}  // namespace atlas
