// SPDX-License-Identifier: MIT
// A detection box and the lidar depths inside it become a frustum: the piece of the viewing pyramid between
// two planes z = const of the optical frame (paper IV-C). Depth is z along the optical axis, so a bearing
// (x/z, y/z, 1) times the depth is the point itself, at the image's border as well as at its centre.
#pragma once

#include <optional>
#include <vector>

#include "atlas/camera/camera_model.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

/// Median and its standard deviation.
struct RobustDepth {
  double median_m = 0;
  double sigma_m = 0;
};
/// The true median (mean of the two middle values for an even count). `depths_m` is reordered; empty gives
/// kNoPoints.
Outcome<RobustDepth> robustDepth(std::vector<float>& depths_m);

/// The part of the box inside the image; kNotFinite, or kEmpty when nothing of it is inside.
Outcome<Detection2d> clipToImage(const Detection2d& box, const CameraModel& model);

/// Frustum of the box, which must lie in the image, between depth.median_m and object_depth_m behind it, in
/// map. detection_index, detection and points are left to the caller; kNotFinite where the lens has no
/// bearing for a corner.
Outcome<Frustum> makeFrustum(const Detection2d& box_in_image, const RobustDepth& depth, double object_depth_m,
                             const CameraModel& model, const Pose& T_map_camera);

}  // namespace atlas
