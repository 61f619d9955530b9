// SPDX-License-Identifier: MIT
#include "atlas/grid/occupancy_filter.hpp"

#include <stdexcept>
#include <string>

#include "atlas/grid/lattice_filter.hpp"
#include "atlas/grid/tay_filter.hpp"

namespace atlas {
namespace {

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("occupancy filter: " + what + ", got " + std::to_string(value));
}

}  // namespace

void validate(const FilterParams& p) {
  need(!p.levels_mps.empty() && p.levels_mps.size() <= 12, "levels_mps must have 1 to 12 entries",
       static_cast<double>(p.levels_mps.size()));
  double below = 0.0;
  for (const double level : p.levels_mps) {
    need(level > below && level <= 100.0, "levels_mps must rise from above 0 to at most 100", level);
    below = level;
  }
  need(p.static_share >= 0.0 && p.static_share <= 1.0, "static_share must lie in [0, 1]", p.static_share);
  need(p.static_share_free >= 0.0 && p.static_share_free <= 1.0, "static_share_free must lie in [0, 1]",
       p.static_share_free);
  for (const auto& [name, rate] : {std::pair<const char*, double>{"birth_per_s", p.birth_per_s},
                                   {"vanish_per_s", p.vanish_per_s},
                                   {"change_per_s", p.change_per_s},
                                   {"accelerate_per_s", p.accelerate_per_s},
                                   {"start_per_s", p.start_per_s},
                                   {"stop_per_s", p.stop_per_s}})
    need(rate >= 0.0 && rate <= 100.0, std::string(name) + " must lie in [0, 100]", rate);
  for (const auto& [name, time] : {std::pair<const char*, double>{"forget_free_s", p.forget_free_s},
                                   {"forget_moving_s", p.forget_moving_s},
                                   {"forget_static_s", p.forget_static_s}})
    need(time > 0.0 && time <= 3600.0, std::string(name) + " must lie in (0, 3600]", time);
  need(p.reach_cells >= 1 && p.reach_cells <= 10, "reach_cells must lie in [1, 10]", p.reach_cells);
  need(p.prediction_error > 0.0 && p.prediction_error < 0.5, "prediction_error must lie in (0, 0.5)",
       p.prediction_error);
  need(p.velocity_error > 0.0 && p.velocity_error < 1.0, "velocity_error must lie in (0, 1)",
       p.velocity_error);
}

std::unique_ptr<OccupancyFilter> makeFilter(const FilterParams& params) {
  validate(params);
  if (params.mode == FilterMode::kTay2008) return std::make_unique<TayFilter>(params);
  return std::make_unique<LatticeFilter>(params);
}

}  // namespace atlas
