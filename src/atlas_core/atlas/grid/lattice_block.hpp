// SPDX-License-Identifier: MIT
// A few cells of one row of the lattice filter while they are worked on; equations in lattice_filter.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlas {

/// Velocities are [level_y * side + level_x]; the one in the middle is standing.
struct VelocityLattice {
  int side = 1;
  std::vector<float> speeds;  ///< by level of an axis, ascending, m/s
  [[nodiscard]] int velocities() const { return side * side; }
  [[nodiscard]] int standing() const { return side * side / 2; }
};

/// Probabilities of one step, and the shares of what is new that stands.
struct LatticeRates {
  float birth = 0, change = 0, vanish = 0, accelerate = 0, start = 0, stop = 0;
  float forget_free = 0, forget_moving = 0, forget_static = 0;
  float static_share = 0, static_share_free = 0;
};

struct LatticeBlock {
  static constexpr int kLanes = 8;   ///< cells that are worked on at once
  static constexpr int kGroups = 5;  ///< of lanes: with 81 velocities they fit into the first cache
  static constexpr int kCells = kLanes * kGroups;
  /// Lies anywhere in memory: what a processor without AVX takes for its alignment differs.
  using Lanes = float __attribute__((vector_size(kLanes * sizeof(float)), aligned(4), may_alias));

  explicit LatticeBlock(int velocities)
      : belief(static_cast<std::size_t>(velocities) * kCells),
        next(static_cast<std::size_t>(velocities) * kLanes) {}

  std::vector<float> belief;  ///< J by [velocity * kCells + cell]
  float empty[kCells];        ///< E
  float occupied[kCells];     ///< P(occupied | Z)
  // What is handed out of each cell, as in CellEstimates.
  float probability[kCells], unknown[kCells], static_share[kCells], moving[kCells], saturation[kCells];
  float vx[kCells], vy[kCells], xx[kCells], xy[kCells], yy[kCells];

  std::vector<float> next;  ///< predicted J by [velocity * kLanes + lane], of the lanes at hand
  Lanes predicted_moving, predicted_standing;                    ///< sums of it
  Lanes scale_moving, scale_standing, add_moving, add_standing;  ///< from predicted to estimated
};

/// One step of the lanes `group` of a block whose belief is already where its velocities took it.
void estimateLanes(const VelocityLattice& lattice, const LatticeRates& rates, int group, LatticeBlock& block);

/// Stored probabilities are counts of 1 / 65535, half the memory of floats, which is what the filter's speed
/// depends on.
void fromCounts(const std::uint16_t* counts, int cells, float* probabilities);
void toCounts(const float* probabilities, int cells, std::uint16_t* counts);

}  // namespace atlas
