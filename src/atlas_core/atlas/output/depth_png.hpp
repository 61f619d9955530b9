// SPDX-License-Identifier: MIT
// Depth images as 16-bit PNG in the convention of the KITTI depth benchmark: value = z-depth in m x 256, 0 =
// unknown.
#pragma once

#include <opencv2/core/mat.hpp>

namespace atlas {

/// CV_32FC1 (m, NaN unknown) to CV_16UC1. What does not fit (65535 / 256 = 255.996 m and beyond) is unknown,
/// not clamped.
cv::Mat depthTo16Bit(const cv::Mat& depth_m);
/// CV_8UC1 for the eye: 255 near, falling to 1 at max_depth_m and beyond; 0 = unknown.
cv::Mat depthPreview(const cv::Mat& depth_m, double max_depth_m);

}  // namespace atlas
