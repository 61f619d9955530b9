// SPDX-License-Identifier: MIT
// The filter in the form of Tay et al. 2008 with a state that says no more than is known. Of a cell c:
//   E      it is empty,  U  nothing is known of it (occupied or empty, either as likely),
//   J_0    occupied by something standing,  J_k  occupied by something with velocity v_k;  all add up to 1.
// Prediction, with a(c) = sum_k J_k(c - v_k dt):  E <= 1 - a, the rest is U; what leaves a cell leaves U
// behind. Estimation with L = P(Z|occ) / (P(Z|occ) + P(Z|emp)): occupied * L, E * (1 - L), U / 2, normalized.
// A measurement that says something (w = |2 L - 1|) first resolves the share w of U into halves of E and
// occupied; what shows up where nothing was known mostly stands, what shows up where it was free has come
// (static_share, static_share_free). So a wall that comes into view stands and a car that drives into free
// space moves.
//
// Velocities form a lattice; planes of one velocity lie still in memory and are read with an offset that
// grows by whole cells whenever its v dt has added up to one: no interpolation, so nothing blurs, and the
// error is at most half a cell at any time. A grid that scrolls is one more offset. Each cell is a function
// of its own gathered inputs in a fixed order: any number of threads gives the same bits.
#pragma once

#include <cstdint>

#include "atlas/grid/lattice_block.hpp"
#include "atlas/grid/occupancy_filter.hpp"

namespace atlas {

class LatticeFilter : public OccupancyFilter {
 public:
  explicit LatticeFilter(const FilterParams& params);

  void update(const GridGeometry& geometry, const std::vector<float>& occupied, double dt_s,
              RowWorkers& workers) override;
  void reset() override { geometry_ = GridGeometry{}; }
  [[nodiscard]] const CellEstimates& cells() const override { return cells_; }

 private:
  /// How far the planes of one level have moved along one axis.
  struct Drift {
    double cells = 0;         ///< exactly
    std::int64_t origin = 0;  ///< of the grid, in cells of the planes
    int first = 0, end = 0;   ///< cells of the grid that these planes had before; the others are new
    std::uint32_t slot = 0;   ///< of the grid's first cell
  };
  void begin(const GridGeometry& geometry);
  void move(const GridGeometry& geometry, double dt_s);
  [[nodiscard]] LatticeRates ratesOf(double dt_s) const;
  void updateRow(int row, const std::vector<float>& occupied, const LatticeRates& rates, LatticeBlock& block);
  /// Calls use(plane, drifts, cells of the block) for each velocity and for E.
  template <class Use>
  void forPlanes(LatticeBlock& block, Use&& use);
  void fetch(int row, int first, int count, LatticeBlock& block);
  void putBack(int row, int first, int count, LatticeBlock& block);
  void handOut(std::size_t at, int count, const LatticeBlock& block);

  FilterParams params_;
  VelocityLattice lattice_;
  GridGeometry geometry_;                 ///< of the last update; no cells before the first
  std::vector<Drift> along_x_, along_y_;  ///< by level
  std::vector<std::uint16_t> planes_;     ///< J, [velocity * cells + row slot * columns + column slot]
  std::vector<std::uint16_t> empty_;      ///< E, in the slots of the standing plane
  CellEstimates cells_;
};

}  // namespace atlas
