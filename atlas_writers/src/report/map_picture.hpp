// SPDX-License-Identifier: MIT
// The map from above: highest point of each cell coloured by height, with the trajectory and a scale bar.
// North is up.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "report/trajectory_file.hpp"

namespace atlas::report {

/// CV_8UC3; empty when there are no points. The longer side has at most `side_px` pixels.
cv::Mat drawMap(const std::vector<cv::Point3f>& points, const std::vector<TrajectoryPoint>& trajectory,
                int side_px = 1400);

}  // namespace atlas::report
