// SPDX-License-Identifier: MIT
// Z-buffer: of all points that fall on a pixel the nearest one counts, so the order of the points has no
// influence. Points measured about when the image was taken and older (or later) ones are kept apart, as what
// moves is only where the former are.
#pragma once

#include <opencv2/core/mat.hpp>

#include "atlas/camera/gap_filling.hpp"
#include "atlas/camera/projector.hpp"
#include "atlas/camera/visibility.hpp"

namespace atlas {

class DepthBuffer {
 public:
  DepthBuffer(int width, int height)
      : recent_(height, width, CV_32FC1, cv::Scalar(kNoDepth)), older_(recent_.clone()) {}
  DepthBuffer(const DepthBuffer&) = delete;  // a copied cv::Mat is the same pixels
  DepthBuffer& operator=(const DepthBuffer&) = delete;

  /// `point` lies in the image (Projector::project).
  void add(const ProjectedPoint& point, bool recent = true) {
    // u, v >= -0.5, so truncation rounds to the nearest
    const int column = static_cast<int>(point.u + 0.5F);
    const int row = static_cast<int>(point.v + 0.5F);
    float& depth = (recent ? recent_ : older_).ptr<float>(row)[column];
    if (point.depth_m < depth) depth = point.depth_m;
  }

  /// Only what the camera can see is left; ends the distinction of recent and older.
  void removeInvisible(const VisibilityParams& params);
  /// Fills between the points of a surface, see fillGaps; the result is the confidence.
  cv::Mat fill(const GapFillingParams& params);
  /// The image: CV_32FC1, m; NaN where there is none.
  [[nodiscard]] cv::Mat image() const;

 private:
  void join();

  cv::Mat recent_, older_;  ///< CV_32FC1, kNoDepth where nothing was seen; older_ is empty once joined
};

}  // namespace atlas
