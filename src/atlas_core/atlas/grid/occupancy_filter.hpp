// SPDX-License-Identifier: MIT
// The Bayesian Occupancy Filter: for each cell the probabilities of occupation and of velocity, predicted by
// moving them with their velocities and corrected by what the sensors say (Coue et al. 2006; Tay et al. 2008;
// Paromtchik, Perrollaz, Laugier 2011, eq. (3)). Two kinds: LatticeFilter (default) and TayFilter.
#pragma once

#include <memory>
#include <vector>

#include "atlas/grid/cell_estimates.hpp"
#include "atlas/grid/grid_geometry.hpp"
#include "atlas/grid/row_workers.hpp"

namespace atlas {

enum class FilterMode {
  kLattice,  ///< empty, standing and a lattice of velocities that are kept between whole cells
  kTay2008   ///< as published in 2008: antecedents of one step, histograms of occupied and empty
};

struct FilterParams {
  FilterMode mode = FilterMode::kLattice;
  // lattice
  /// Positive speeds of one axis, ascending; both axes have these, their negatives and 0.
  std::vector<double> levels_mps = {1.5, 3.5, 6.0, 9.5, 14.0};
  double static_share = 0.5;        ///< of a thing that shows up where nothing was known: it stands
  double static_share_free = 0.01;  ///< where it was free: something came here
  double birth_per_s = 3.0;         ///< an empty cell becomes occupied
  double vanish_per_s = 0.2;        ///< an occupied cell becomes empty, beside what moves away
  double change_per_s = 0.2;        ///< something takes up any other velocity
  double accelerate_per_s = 0.4;    ///< something moving takes up the next velocity, each of the four ways
  double start_per_s = 0.04;        ///< something standing takes up a lowest velocity, each of the four
  double stop_per_s = 0.1;          ///< something at a lowest velocity stands
  double forget_free_s = 0.4;       ///< time constants of unseen cells: empty becomes unknown
  double forget_moving_s = 1.0;     ///< a moving thing becomes unknown
  double forget_static_s = 10.0;    ///< a standing thing becomes unknown
  // tay2008
  int reach_cells = 2;             ///< antecedents lie up to so many cells away along each axis
  double prediction_error = 0.05;  ///< occupied becomes empty or the other way round, each step
  double velocity_error = 0.02;    ///< share of the velocities that is evened out, each step
};
void validate(const FilterParams& params);

class OccupancyFilter {
 public:
  virtual ~OccupancyFilter() = default;
  OccupancyFilter() = default;
  OccupancyFilter(const OccupancyFilter&) = delete;
  OccupancyFilter& operator=(const OccupancyFilter&) = delete;

  /// Predicts by dt_s (>= 0) onto `geometry` (same size as before, else everything is forgotten) and corrects
  /// with `occupied` (P(occupied | Z) of each cell, within (0, 1)).
  virtual void update(const GridGeometry& geometry, const std::vector<float>& occupied, double dt_s,
                      RowWorkers& workers) = 0;
  /// Everything is unknown again.
  virtual void reset() = 0;
  [[nodiscard]] virtual const CellEstimates& cells() const = 0;
};

[[nodiscard]] std::unique_ptr<OccupancyFilter> makeFilter(const FilterParams& params);

}  // namespace atlas
