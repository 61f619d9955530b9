// SPDX-License-Identifier: MIT
#include "report/trajectory_file.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

namespace atlas::report {

std::vector<TrajectoryPoint> readTum(const std::filesystem::path& path) {
  std::vector<TrajectoryPoint> trajectory;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::array<double, 8> values{};
    const char* at = line.c_str();
    std::size_t count = 0;
    for (; count < values.size(); ++count) {
      char* end = nullptr;
      values[count] = std::strtod(at, &end);
      if (end == at || !std::isfinite(values[count])) break;
      at = end;
    }
    if (count == values.size()) trajectory.push_back({values[0], values[1], values[2], values[3]});
  }
  return trajectory;
}

double pathLength(const std::vector<TrajectoryPoint>& trajectory, double step_m) {
  double length_m = 0;
  std::size_t last = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double step =
        std::hypot(trajectory[i].x_m - trajectory[last].x_m, trajectory[i].y_m - trajectory[last].y_m);
    if (step < step_m) continue;
    length_m += step;
    last = i;
  }
  return length_m;
}

}  // namespace atlas::report
