// SPDX-License-Identifier: MIT
#include "atlas/grid/lattice_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atlas/base/check.hpp"

namespace atlas {
namespace {

constexpr int kBlock = LatticeBlock::kCells;

/// P(change within dt) for changes at a rate; no exponential, so the same everywhere.
float share(double rate_per_s, double dt_s) {
  return static_cast<float>(rate_per_s * dt_s / (1.0 + rate_per_s * dt_s));
}

std::uint32_t wrapped(std::int64_t cell, int cells) {
  const std::int64_t rest = cell % cells;
  return static_cast<std::uint32_t>(rest < 0 ? rest + cells : rest);
}

/// Cells of a row from `first` on are stored from `slot` on and, if there are more of them, from 0 on.
struct Stretch {
  std::size_t row = 0;
  int slot = 0, before_wrap = 0;
};

}  // namespace

LatticeFilter::LatticeFilter(const FilterParams& params) : params_(params) {
  const int levels = static_cast<int>(params.levels_mps.size());
  lattice_.side = 2 * levels + 1;
  for (int i = -levels; i <= levels; ++i) {
    const double speed = i == 0 ? 0.0 : params.levels_mps[static_cast<std::size_t>(std::abs(i) - 1)];
    lattice_.speeds.push_back(static_cast<float>(i < 0 ? -speed : speed));
  }
}

void LatticeFilter::begin(const GridGeometry& geometry) {
  geometry_ = geometry;
  Drift x, y;
  x.origin = geometry.first_column;
  y.origin = geometry.first_row;
  along_x_.assign(lattice_.side, x);
  along_y_.assign(lattice_.side, y);
  planes_.assign(geometry.cells() * static_cast<std::size_t>(lattice_.velocities()), 0);
  empty_.assign(geometry.cells(), 0);
  cells_.resize(geometry.cells());
}

void LatticeFilter::move(const GridGeometry& geometry, double dt_s) {
  const auto follow = [&](std::vector<Drift>& drifts, std::int64_t first, int cells) {
    for (int level = 0; level < lattice_.side; ++level) {
      Drift& drift = drifts[level];
      drift.cells += lattice_.speeds[level] * dt_s / geometry.cell_m;
      const std::int64_t origin = first - std::llround(drift.cells), step = origin - drift.origin;
      drift.first = static_cast<int>(std::clamp<std::int64_t>(-step, 0, cells));
      drift.end = static_cast<int>(std::clamp<std::int64_t>(cells - step, 0, cells));
      drift.origin = origin;
      drift.slot = wrapped(origin, cells);
    }
  };
  follow(along_x_, geometry.first_column, geometry.columns);
  follow(along_y_, geometry.first_row, geometry.rows);
  geometry_ = geometry;
}

LatticeRates LatticeFilter::ratesOf(double dt_s) const {
  LatticeRates rates;
  rates.birth = share(params_.birth_per_s, dt_s);
  rates.change = share(params_.change_per_s, dt_s);
  rates.vanish = share(params_.vanish_per_s, dt_s);
  rates.accelerate = 0.25F * share(4.0 * params_.accelerate_per_s, dt_s);
  rates.start = 0.25F * share(4.0 * params_.start_per_s, dt_s);
  rates.stop = 0.25F * share(4.0 * params_.stop_per_s, dt_s);
  rates.forget_free = share(1.0 / params_.forget_free_s, dt_s);
  rates.forget_moving = share(1.0 / params_.forget_moving_s, dt_s);
  rates.forget_static = share(1.0 / params_.forget_static_s, dt_s);
  rates.static_share = static_cast<float>(params_.static_share);
  rates.static_share_free = static_cast<float>(params_.static_share_free);
  return rates;
}

void LatticeFilter::update(const GridGeometry& geometry, const std::vector<float>& occupied, double dt_s,
                           RowWorkers& workers) {
  ATLAS_CHECK(occupied.size() == geometry.cells(), "evidence of another size than the grid");
  ATLAS_CHECK(dt_s >= 0.0, "a step back in time");
  if (geometry.columns != geometry_.columns || geometry.rows != geometry_.rows ||
      geometry.cell_m != geometry_.cell_m)
    begin(geometry);
  move(geometry, dt_s);
  const LatticeRates rates = ratesOf(dt_s);
  workers.run(geometry.rows, [&](int first, int end) {
    LatticeBlock block(lattice_.velocities());
    for (int row = first; row < end; ++row) updateRow(row, occupied, rates, block);
  });
}

void LatticeFilter::updateRow(int row, const std::vector<float>& occupied, const LatticeRates& rates,
                              LatticeBlock& block) {
  for (int first = 0; first < geometry_.columns; first += kBlock) {
    const int count = std::min(kBlock, geometry_.columns - first);
    const std::size_t at = geometry_.indexOf(first, row);
    fetch(row, first, count, block);
    std::fill(std::begin(block.occupied), std::end(block.occupied), 0.5F);
    std::copy_n(occupied.data() + at, count, block.occupied);
    for (int group = 0; group * LatticeBlock::kLanes < count; ++group)
      estimateLanes(lattice_, rates, group, block);
    putBack(row, first, count, block);
    handOut(at, count, block);
  }
}

template <class Use>
void LatticeFilter::forPlanes(LatticeBlock& block, Use&& use) {
  for (int ky = 0, k = 0; ky < lattice_.side; ++ky) {
    for (int kx = 0; kx < lattice_.side; ++kx, ++k)
      use(planes_.data() + geometry_.cells() * static_cast<std::size_t>(k), along_x_[kx], along_y_[ky],
          block.belief.data() + static_cast<std::ptrdiff_t>(k) * kBlock);
  }
  const int still = lattice_.side / 2;
  use(empty_.data(), along_x_[still], along_y_[still], block.empty);
}

namespace {

template <class Drift>
Stretch stretchOf(const Drift& x, const Drift& y, int row, int first, int count,
                  const GridGeometry& geometry) {
  Stretch s;
  const int row_slot = static_cast<int>(y.slot) + std::min(row, geometry.rows - 1),
            slot = static_cast<int>(x.slot) + first;
  s.row = static_cast<std::size_t>(row_slot >= geometry.rows ? row_slot - geometry.rows : row_slot) *
          static_cast<std::size_t>(geometry.columns);
  s.slot = slot >= geometry.columns ? slot - geometry.columns : slot;
  s.before_wrap = std::min(count, geometry.columns - s.slot);
  return s;
}

}  // namespace

void LatticeFilter::fetch(int row, int first, int count, LatticeBlock& block) {
  forPlanes(block, [&](const std::uint16_t* plane, const Drift& x, const Drift& y, float* cells) {
    const bool new_row = row < y.first || row >= y.end;
    const int known = new_row ? count : std::clamp(x.first - first, 0, count);
    const int known_end = new_row ? count : std::clamp(x.end - first, known, count);
    const Stretch s = stretchOf(x, y, row, first, count, geometry_);
    if (!new_row) {
      fromCounts(plane + s.row + s.slot, s.before_wrap, cells);
      fromCounts(plane + s.row, count - s.before_wrap, cells + s.before_wrap);
    }
    // The next row of each velocity lies somewhere else: without being told, no processor fetches 81 of them.
    const Stretch next = stretchOf(x, y, row + 1, first, count, geometry_);
    const std::uint16_t* ahead = plane + next.row + next.slot;
    __builtin_prefetch(ahead);
    __builtin_prefetch(ahead + 32);
    std::fill(cells, cells + known, 0.0F);
    std::fill(cells + known_end, cells + kBlock, 0.0F);
  });
}

void LatticeFilter::putBack(int row, int first, int count, LatticeBlock& block) {
  forPlanes(block, [&](std::uint16_t* plane, const Drift& x, const Drift& y, const float* cells) {
    const Stretch s = stretchOf(x, y, row, first, count, geometry_);
    toCounts(cells, s.before_wrap, plane + s.row + s.slot);
    toCounts(cells + s.before_wrap, count - s.before_wrap, plane + s.row);
  });
}

void LatticeFilter::handOut(std::size_t at, int count, const LatticeBlock& block) {
  for (const auto& [cells, values] :
       {std::pair<std::vector<float>*, const float*>{&cells_.occupied, block.probability},
        {&cells_.unknown, block.unknown},
        {&cells_.static_share, block.static_share},
        {&cells_.vx_mps, block.vx},
        {&cells_.vy_mps, block.vy},
        {&cells_.var_xx, block.xx},
        {&cells_.var_xy, block.xy},
        {&cells_.var_yy, block.yy},
        {&cells_.moving, block.moving},
        {&cells_.saturation, block.saturation}})
    std::copy_n(values, count, cells->data() + at);
}

}  // namespace atlas
