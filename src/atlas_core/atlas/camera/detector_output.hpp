// SPDX-License-Identifier: MIT
// From an image to the input of a YOLO network and from its output back to boxes in the image. Which of the
// usual layouts the output has is seen from its shape:
//   v5, v7    1 x N x (5 + C)    cx cy w h objectness class scores
//   v8, v11   1 x (4 + C) x N    cx cy w h class scores, one column a box
// N (boxes) is much larger than the other number. A box that says nothing else is in pixels of the input.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// The picture made as large as it fits, in the middle of a square of grey 114.
struct Letterbox {
  double scale = 1.0;            ///< pixels of the input per pixel of the image
  double left = 0.0, top = 0.0;  ///< px of the input, edge of the picture in it
};
Letterbox letterboxOf(const cv::Size& image, int side_px);

/// 1 x 3 x side x side, float, RGB, 0 to 1, of an 8-bit grey or BGR image.
cv::Mat networkInput(const cv::Mat& image, int side_px);

struct DetectionLimits {
  double confidence = 0.25;  ///< least; objectness times class score
  double overlap = 0.45;     ///< intersection over union from which the weaker of a class is the same object
  int most = 300;            ///< boxes of an image, strongest first
};
/// Throws std::invalid_argument naming the parameter.
void validate(const DetectionLimits& limits);

/// Boxes in pixels of the image, strongest first; order is total, so it does not depend on how a network ends
/// a tie. Throws std::runtime_error naming the shape when it is none of the layouts. `classes`: how many the
/// model has, 0 = whatever the shape says.
std::vector<Detection2d> detectionsOf(const cv::Mat& output, const cv::Size& image, int side_px,
                                      const DetectionLimits& limits, int classes = 0);

}  // namespace atlas
