// SPDX-License-Identifier: MIT
// Where the road is, from what was measured: among the disparities of each row (v-disparity, Labayrade,
// Aubert and Tarel 2002) the road is a straight line that rises with the row, things that stand on it are
// upright. The line that most pixels lie on is looked for, then fitted to them.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "atlas/stereo/disparity_image.hpp"
#include "atlas/stereo/stereo_rig.hpp"

namespace atlas {

struct RoadFitParams {
  double min_height_m = 0.6, max_height_m = 3.5;  ///< of the camera above the road
  double max_pitch_deg = 5.0;                     ///< of the camera, up or down
  double inlier_px = 1.0;                         ///< of disparity; nearer to the line is road
  double min_road_share = 0.25;  ///< of the pixels below the horizon; fewer: the road is unknown
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const RoadFitParams& params);

/// `disparity`: CV_32SC1, 1/256 px, < 0 where there is none, of an image of the rig's size. `prior`: that of
/// the image before; a line near it is taken when it fits as well. nullopt: no line fits enough of the
/// pixels.
std::optional<RoadProfile> fitRoad(const cv::Mat& disparity, const StereoRig& rig,
                                   const RoadFitParams& params, const std::optional<RoadProfile>& prior);

/// The road that a camera at `height_m` above it sees, tilted down by `pitch_rad`.
RoadProfile roadFromCamera(const StereoRig& rig, double height_m, double pitch_rad);

}  // namespace atlas
