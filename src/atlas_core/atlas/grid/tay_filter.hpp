// SPDX-License-Identifier: MIT
// The filter as published (Tay, Mekhnacha, Chen, Yguel, Laugier 2008, "An Efficient Formulation of the
// Bayesian Occupation Filter"), for comparison. The antecedents A of a cell c are the cells from which it is
// reached in one step, so each antecedent is a velocity:
//   alpha(o, v_k)(c) = sum_{o'} P(o | o') P(o' | a_k) P(v_k | a_k),   a_k = c - v_k dt
//   beta(o, v_k) = P(Z | o) alpha(o, v_k),   l(v_k) = beta(occ, v_k) + beta(emp, v_k)
//   P(occ | Z) = sum_k beta(occ, v_k) / sum_k l(v_k),   P(v_k | Z) = l(v_k) / sum_k l(v_k)
// Velocities are whole cells a step: with another dt they are others. Known limits, kept: empty cells take
// part in the velocities, there is no standing class, nothing below one cell a step can be told from
// standing.
#pragma once

#include <cstdint>

#include "atlas/grid/occupancy_filter.hpp"

namespace atlas {

class TayFilter : public OccupancyFilter {
 public:
  explicit TayFilter(const FilterParams& params);

  void update(const GridGeometry& geometry, const std::vector<float>& occupied, double dt_s,
              RowWorkers& workers) override;
  void reset() override { geometry_ = GridGeometry{}; }
  [[nodiscard]] const CellEstimates& cells() const override { return cells_; }

 private:
  struct Sums;
  void begin(const GridGeometry& geometry);
  void updateRow(int row, const std::vector<float>& occupied, bool moves, Sums& sums);
  void gather(int row, int velocity, const std::vector<float>& occupied, bool moves, Sums& sums);
  void store(int row, Sums& sums);

  FilterParams params_;
  int side_ = 0;
  double dt_s_ = 0;  ///< of the last step that took time
  GridGeometry geometry_;
  std::int64_t step_columns_ = 0, step_rows_ = 0;  ///< of the grid in this step
  std::vector<float> occupied_, next_occupied_;
  std::vector<float> velocities_, next_velocities_;  ///< P(v_k), [k * cells + cell]
  CellEstimates cells_;
};

}  // namespace atlas
