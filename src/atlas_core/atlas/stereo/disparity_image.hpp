// SPDX-License-Identifier: MIT
// What matching a rectified pair gives: how far each pixel of the left image is, and what it is part of.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>

namespace atlas {

/// The road as a plane in the image: on it the disparity of a row is slope_px * (row - horizon_row). The
/// slope is baseline / height of the camera above the road (times the cosine of its pitch).
struct RoadProfile {
  double horizon_row = 0;  ///< px, may lie outside the image
  double slope_px = 0;     ///< px of disparity a row
  [[nodiscard]] double disparityAt(double row) const { return slope_px * (row - horizon_row); }
};

/// Counts of 1/256 px in a disparity image.
constexpr int kDisparityScale = 256;

enum class SurfaceLabel : std::uint8_t { kUnknown = 0, kObstacle = 1, kRoad = 2 };

struct DisparityImage {
  cv::Mat disparity;  ///< CV_16UC1, px * kDisparityScale, 0 = unknown
  cv::Mat surface;    ///< CV_8UC1 of SurfaceLabel; what has no disparity is unknown
  /// As it is in this image; without one every pixel with a disparity is an obstacle.
  std::optional<RoadProfile> road;
};

}  // namespace atlas
