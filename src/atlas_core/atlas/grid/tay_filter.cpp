// SPDX-License-Identifier: MIT
#include "atlas/grid/tay_filter.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/base/check.hpp"

namespace atlas {

/// Of one row, by column.
struct TayFilter::Sums {
  explicit Sums(int columns)
      : all(columns),
        occupied(columns),
        still(columns),
        x(columns),
        y(columns),
        xx(columns),
        xy(columns),
        yy(columns),
        edge(columns) {}
  void clear() {
    for (auto* sum : {&all, &occupied, &still, &x, &y, &xx, &xy, &yy, &edge})
      std::fill(sum->begin(), sum->end(), 0.0F);
  }
  std::vector<float> all, occupied, still, x, y, xx, xy, yy, edge;
};

TayFilter::TayFilter(const FilterParams& params) : params_(params), side_(2 * params.reach_cells + 1) {}

void TayFilter::begin(const GridGeometry& geometry) {
  geometry_ = geometry;
  const std::size_t velocities = static_cast<std::size_t>(side_ * side_);
  occupied_.assign(geometry.cells(), 0.5F);
  next_occupied_ = occupied_;
  velocities_.assign(geometry.cells() * velocities, 1.0F / static_cast<float>(velocities));
  next_velocities_ = velocities_;
  cells_.resize(geometry.cells());
}

void TayFilter::update(const GridGeometry& geometry, const std::vector<float>& occupied, double dt_s,
                       RowWorkers& workers) {
  ATLAS_CHECK(occupied.size() == geometry.cells(), "evidence of another size than the grid");
  ATLAS_CHECK(dt_s >= 0.0, "a step back in time");
  if (geometry.columns != geometry_.columns || geometry.rows != geometry_.rows ||
      geometry.cell_m != geometry_.cell_m)
    begin(geometry);
  step_columns_ = geometry.first_column - geometry_.first_column;
  step_rows_ = geometry.first_row - geometry_.first_row;
  geometry_ = geometry;
  const bool moves = dt_s > 0.0;
  if (moves) dt_s_ = dt_s;
  workers.run(geometry.rows, [&](int first, int end) {
    Sums sums(geometry_.columns);
    for (int row = first; row < end; ++row) updateRow(row, occupied, moves, sums);
  });
  occupied_.swap(next_occupied_);
  velocities_.swap(next_velocities_);
}

void TayFilter::updateRow(int row, const std::vector<float>& occupied, bool moves, Sums& sums) {
  sums.clear();
  for (int k = 0; k < side_ * side_; ++k) gather(row, k, occupied, moves, sums);
  store(row, sums);
}

void TayFilter::gather(int row, int velocity, const std::vector<float>& occupied, bool moves, Sums& sums) {
  const int step_x = velocity % side_ - params_.reach_cells, step_y = velocity / side_ - params_.reach_cells;
  const float per_s = dt_s_ > 0.0 ? static_cast<float>(geometry_.cell_m / dt_s_) : 0.0F;
  const float vx = per_s * static_cast<float>(step_x), vy = per_s * static_cast<float>(step_y);
  const bool edge = std::max(std::abs(step_x), std::abs(step_y)) == params_.reach_cells;
  const auto eps = moves ? static_cast<float>(params_.prediction_error) : 0.0F;
  const float even = 1.0F / static_cast<float>(side_ * side_);
  const std::size_t plane = geometry_.cells() * static_cast<std::size_t>(velocity);
  const std::int64_t from_row = row + step_rows_ - (moves ? step_y : 0);
  for (int column = 0; column < geometry_.columns; ++column) {
    const std::int64_t from_column = column + step_columns_ - (moves ? step_x : 0);
    float was_occupied = 0.5F, had_velocity = even;  // nothing is known of what comes from outside
    if (from_row >= 0 && from_row < geometry_.rows && from_column >= 0 && from_column < geometry_.columns) {
      const std::size_t from = geometry_.indexOf(static_cast<int>(from_column), static_cast<int>(from_row));
      was_occupied = occupied_[from];
      had_velocity = velocities_[plane + from];
    }
    const std::size_t cell = geometry_.indexOf(column, row);
    const float L = occupied[cell];
    const float predicted = (1.0F - eps) * was_occupied + eps * (1.0F - was_occupied);
    const float beta_occupied = L * predicted * had_velocity;
    const float likely = beta_occupied + (1.0F - L) * (1.0F - predicted) * had_velocity;
    next_velocities_[plane + cell] = likely;
    sums.all[column] += likely;
    sums.occupied[column] += beta_occupied;
    if (step_x == 0 && step_y == 0) {
      sums.still[column] = beta_occupied;
      continue;
    }
    sums.x[column] += beta_occupied * vx;
    sums.y[column] += beta_occupied * vy;
    sums.xx[column] += beta_occupied * vx * vx;
    sums.xy[column] += beta_occupied * vx * vy;
    sums.yy[column] += beta_occupied * vy * vy;
    if (edge) sums.edge[column] += beta_occupied;
  }
}

void TayFilter::store(int row, Sums& sums) {
  constexpr float kTiny = 1e-12F;
  const auto error = static_cast<float>(params_.velocity_error);
  const int velocities = side_ * side_;
  const std::size_t first = geometry_.indexOf(0, row);
  for (int column = 0; column < geometry_.columns; ++column) {
    const std::size_t cell = first + static_cast<std::size_t>(column);
    const float occupied = sums.occupied[column] / sums.all[column];
    next_occupied_[cell] = occupied;
    cells_.occupied[cell] = occupied;
    cells_.unknown[cell] = 1.0F - std::abs(2.0F * occupied - 1.0F);
    const float moving = sums.occupied[column] - sums.still[column];
    cells_.static_share[cell] =
        sums.occupied[column] > kTiny ? sums.still[column] / sums.occupied[column] : 0.0F;
    cells_.moving[cell] = occupied * (1.0F - cells_.static_share[cell]);
    const float per = moving > kTiny ? 1.0F / moving : 0.0F;
    const float vx = per * sums.x[column], vy = per * sums.y[column];
    cells_.vx_mps[cell] = vx;
    cells_.vy_mps[cell] = vy;
    cells_.var_xx[cell] = std::max(0.0F, per * sums.xx[column] - vx * vx);
    cells_.var_xy[cell] = per * sums.xy[column] - vx * vy;
    cells_.var_yy[cell] = std::max(0.0F, per * sums.yy[column] - vy * vy);
    cells_.saturation[cell] = std::min(1.0F, per * sums.edge[column]);
    sums.all[column] = 1.0F / sums.all[column];
  }
  const float even = error / static_cast<float>(velocities);
  for (int k = 0; k < velocities; ++k) {
    float* next = next_velocities_.data() + geometry_.cells() * static_cast<std::size_t>(k) + first;
    for (int column = 0; column < geometry_.columns; ++column)
      next[column] = (1.0F - error) * next[column] * sums.all[column] + even;
  }
}

}  // namespace atlas
