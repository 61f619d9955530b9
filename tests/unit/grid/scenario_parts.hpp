// SPDX-License-Identifier: MIT
// The scenarios one by one; what each asks stands at its scene.
#pragma once

#include <vector>

#include "scenarios.hpp"
#include "scene_run.hpp"

namespace atlas::grid_scene {

// objects
[[nodiscard]] std::vector<Figure> bicycleBesideCar(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> twoPedestrians(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> behindTheBus(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> turningCar(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> busInTwo(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> saturation(FilterMode mode, unsigned seed);
// cells
[[nodiscard]] std::vector<Figure> street(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> sharpTurn(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> rangeError(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> emptyRoad(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> conflict(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> unevenTimes(FilterMode mode, unsigned seed);
[[nodiscard]] std::vector<Figure> reproducible(FilterMode mode, unsigned seed);

/// Share of the cells of standing actors with P(occupied) > 0.6 that the filter takes for moving: faster than
/// 1 m/s and more likely moving than standing.
struct CellCount {
  std::size_t all = 0, wrong = 0;
  [[nodiscard]] double share() const {
    return all > 0 ? static_cast<double>(wrong) / static_cast<double>(all) : 0.0;
  }
};
void countFalseDynamic(const Scene& scene, const Step& step, CellCount& count);

/// Figures with a limit below or above, and without one.
[[nodiscard]] inline Figure atLeast(const std::string& name, double value, double limit,
                                    const std::string& unit = "") {
  return {"", name, unit, value, limit, true, true};
}
[[nodiscard]] inline Figure atMost(const std::string& name, double value, double limit,
                                   const std::string& unit = "") {
  return {"", name, unit, value, limit, false, true};
}
[[nodiscard]] inline Figure told(const std::string& name, double value, const std::string& unit = "") {
  return {"", name, unit, value, 0.0, false, false};
}

/// Calls visit(index, middle) for each cell.
template <class Visit>
void forCells(const OccupancyFrame& frame, Visit&& visit) {
  for (int row = 0; row < frame.geometry.rows; ++row) {
    for (int column = 0; column < frame.geometry.columns; ++column)
      visit(frame.geometry.indexOf(column, row), frame.geometry.middleOf(column, row));
  }
}

[[nodiscard]] inline RunOptions options(FilterMode mode, unsigned seed) {
  RunOptions result;
  result.mode = mode;
  result.sensors.seed = seed;
  return result;
}

}  // namespace atlas::grid_scene
