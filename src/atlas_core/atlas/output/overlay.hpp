// SPDX-License-Identifier: MIT
// Pictures for people: what the fusion made, drawn over the camera image it was made from.
#pragma once

#include <opencv2/core/mat.hpp>

#include "atlas/sensor/products.hpp"

namespace atlas {

/// Lidar points as half transparent dots, red at 2 m to blue at max_depth_m (logarithmic). `depth_m`:
/// CV_32FC1 of the image's size, NaN unknown (sparse).
cv::Mat drawDepth(const cv::Mat& image, const cv::Mat& depth_m, double max_depth_m = 60.0);
/// Boxes with class and distance.
cv::Mat drawFrustums(const cv::Mat& image, const Frustums& frustums);
/// Boxes with class and confidence.
cv::Mat drawDetections(const cv::Mat& image, const Detections& detections);

}  // namespace atlas
