// SPDX-License-Identifier: MIT
#include "scenarios.hpp"

#include <functional>
#include <map>
#include <stdexcept>

#include "scenario_parts.hpp"

namespace atlas::grid_scene {
namespace {

using Scenario = std::function<std::vector<Figure>(FilterMode, unsigned)>;

const std::vector<std::pair<std::string, Scenario>>& scenarios() {
  static const std::vector<std::pair<std::string, Scenario>> all = {
      {"S0", street},       {"S1", bicycleBesideCar}, {"S2", twoPedestrians}, {"S3", behindTheBus},
      {"S4", sharpTurn},    {"S5", turningCar},       {"S6", rangeError},     {"S7", emptyRoad},
      {"S8", busInTwo},     {"S9", conflict},         {"S10", saturation},    {"S11", unevenTimes},
      {"S12", reproducible}};
  return all;
}

}  // namespace

std::vector<std::string> scenarioNames() {
  std::vector<std::string> names;
  for (const auto& [name, scenario] : scenarios()) names.push_back(name);
  return names;
}

std::vector<Figure> runScenario(const std::string& name, FilterMode mode, int seeds) {
  for (const auto& [known, scenario] : scenarios()) {
    if (known != name) continue;
    std::vector<Figure> mean;
    for (int seed = 1; seed <= seeds; ++seed) {
      std::vector<Figure> figures = scenario(mode, static_cast<unsigned>(seed));
      if (mean.empty()) {
        mean = figures;
        for (Figure& figure : mean) figure.value = 0.0;
      }
      for (std::size_t i = 0; i < figures.size(); ++i) mean[i].value += figures[i].value / seeds;
    }
    for (Figure& figure : mean) figure.scenario = name;
    return mean;
  }
  throw std::invalid_argument("no scenario " + name);
}

}  // namespace atlas::grid_scene
