// SPDX-License-Identifier: MIT
// Reads trajectory.tum: lines "stamp x y z qx qy qz qw", metres in map, x east and y north.
#pragma once

#include <filesystem>
#include <vector>

namespace atlas::report {

struct TrajectoryPoint {
  double stamp_s = 0, x_m = 0, y_m = 0, z_m = 0;
};

/// Lines that are not eight finite numbers are left out; empty when the file is not there.
std::vector<TrajectoryPoint> readTum(const std::filesystem::path& path);

/// Length of the path over ground, m, from points at least `step_m` apart, so that noise at standstill does
/// not count.
double pathLength(const std::vector<TrajectoryPoint>& trajectory, double step_m = 0.5);

}  // namespace atlas::report
