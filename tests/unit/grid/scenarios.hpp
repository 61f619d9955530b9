// SPDX-License-Identifier: MIT
// Scenes with a known truth, each of which asks one thing of the occupancy filter and its objects, run with
// both kinds of the filter. A figure is what was measured; whether it passes is told by a limit that comes
// from the sensors' noise, the cells' size and the paper's own claims.
#pragma once

#include <string>
#include <vector>

#include "atlas/grid/occupancy_filter.hpp"

namespace atlas::grid_scene {

struct Figure {
  std::string scenario, name, unit;
  double value = 0;
  double limit = 0;
  bool at_least = false;  ///< the value must not fall below the limit; else not exceed it
  bool judged = true;     ///< false: told for comparison only
  [[nodiscard]] bool passes() const { return !judged || (at_least ? value >= limit : value <= limit); }
};

/// "S1" .. "S12".
[[nodiscard]] std::vector<std::string> scenarioNames();
/// The figures of one scenario, mean over the seeds 1 .. seeds.
[[nodiscard]] std::vector<Figure> runScenario(const std::string& name, FilterMode mode, int seeds);

}  // namespace atlas::grid_scene
