// SPDX-License-Identifier: MIT
// The trajectory from above as an SVG: equal scales, grid in metres, coloured by speed.
#pragma once

#include <string>
#include <vector>

#include "report/trajectory_file.hpp"

namespace atlas::report {

/// Empty text for fewer than two points.
std::string trajectorySvg(const std::vector<TrajectoryPoint>& trajectory);

/// Distance of grid lines for a span: 1, 2 or 5 times a power of ten, giving 4 to 10 lines.
double gridStep(double span_m);

}  // namespace atlas::report
