// SPDX-License-Identifier: MIT
// Runs the scenarios of the occupancy filter with both kinds of it and prints the table of BENCHMARK.md:
//   grid_scenarios [SEEDS [SCENARIO...]]      default: 3 seeds, all scenarios
// Ends with the number of limits that the default kind misses.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "scenarios.hpp"

namespace {

std::string textOf(const atlas::grid_scene::Figure& figure) {
  if (std::isnan(figure.value)) return figure.judged ? "nothing seen (missed)" : "nothing seen";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", figure.value);
  return std::string(text) + (figure.passes() ? "" : " (missed)");
}

}  // namespace

int main(int argc, char** argv) {
  using namespace atlas;
  using namespace atlas::grid_scene;
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 3;
  if (seeds < 1 || seeds > 1000) {
    std::fprintf(stderr, "grid_scenarios: SEEDS must lie in [1, 1000], got %s\n", argv[1]);
    return 2;
  }
  std::vector<std::string> names =
      argc > 2 ? std::vector<std::string>(argv + 2, argv + argc) : scenarioNames();
  std::printf("| scenario | figure | limit | tay2008 | lattice |\n|---|---|---|---|---|\n");
  int missed = 0;
  try {
    for (const std::string& name : names) {
      const auto tay = runScenario(name, FilterMode::kTay2008, seeds),
                 lattice = runScenario(name, FilterMode::kLattice, seeds);
      for (std::size_t i = 0; i < lattice.size(); ++i) {
        const Figure& figure = lattice[i];
        char limit[32] = "";
        if (figure.judged)
          std::snprintf(limit, sizeof limit, "%s %.3g", figure.at_least ? ">=" : "<=", figure.limit);
        std::printf("| %s | %s%s%s | %s | %s | %s |\n", name.c_str(), figure.name.c_str(),
                    figure.unit.empty() ? "" : ", ", figure.unit.c_str(), limit, textOf(tay[i]).c_str(),
                    textOf(figure).c_str());
        missed += figure.passes() ? 0 : 1;
      }
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "grid_scenarios: %s\n", error.what());
    return 2;
  }
  std::printf("\nlattice misses %d limits\n", missed);
  return 0;
}
