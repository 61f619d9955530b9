// SPDX-License-Identifier: MIT
// Z-buffer: of all points that fall on a pixel the nearest one counts, so the order of the points has no
// influence.
#pragma once

#include <limits>
#include <opencv2/core/mat.hpp>

#include "atlas/camera/projector.hpp"

namespace atlas {

class DepthBuffer {
 public:
  DepthBuffer(int width, int height) : nearest_(height, width, CV_32FC1, cv::Scalar(kNothing)) {}

  /// `point` lies in the image (Projector::project).
  void add(const ProjectedPoint& point) {
    // u, v >= -0.5, so truncation rounds to the nearest
    const int column = static_cast<int>(point.u + 0.5F);
    const int row = static_cast<int>(point.v + 0.5F);
    float& depth = nearest_.ptr<float>(row)[column];
    if (point.depth_m < depth) depth = point.depth_m;
  }

  /// The image: every point covers the square of half side splat_px around its pixel; NaN where there is
  /// none.
  [[nodiscard]] cv::Mat image(int splat_px) const;

 private:
  /// Also what cv::erode takes for pixels outside the image; infinity would become this at the border.
  static constexpr float kNothing = std::numeric_limits<float>::max();

  cv::Mat nearest_;  ///< CV_32FC1, kNothing where nothing was seen
};

}  // namespace atlas
