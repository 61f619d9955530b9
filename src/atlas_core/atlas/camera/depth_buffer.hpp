// SPDX-License-Identifier: MIT
// Z-buffer: of all points that fall on a pixel the nearest one counts, so the order of the points has no
// influence. Points measured about when the image was taken and older (or later) ones are kept apart, as what
// moves is only where the former are. Costs the time of its points, not of its pixels, once it exists.
#pragma once

#include <algorithm>
#include <opencv2/core/mat.hpp>

#include "atlas/camera/gap_filling.hpp"
#include "atlas/camera/image_pool.hpp"
#include "atlas/camera/pixel_set.hpp"
#include "atlas/camera/projector.hpp"
#include "atlas/camera/visibility.hpp"

namespace atlas {

class DepthBuffer {
 public:
  DepthBuffer(int width, int height) : recent_(width, height), older_(width, height) {}
  DepthBuffer(const DepthBuffer&) = delete;  // a copied cv::Mat is the same pixels
  DepthBuffer& operator=(const DepthBuffer&) = delete;
  [[nodiscard]] cv::Size size() const { return recent_.depth.size(); }

  /// `point` lies in the image (Projector::project).
  void add(const ProjectedPoint& point, bool recent = true) {
    // u, v >= -0.5, so truncation rounds to the nearest
    const int column = static_cast<int>(point.u + 0.5F);
    const int row = static_cast<int>(point.v + 0.5F);
    SparseDepth& layer = recent ? recent_ : older_;
    float& depth = layer.depth.ptr<float>(row)[column];
    depth = std::min(depth, point.depth_m);  // no branch: nobody can guess which point is the nearer
    layer.pixels.add(row, column);
  }

  /// Only what the camera can see is left; ends the distinction of recent and older.
  void removeInvisible(const VisibilityParams& params);

  /// Images of CV_32FC1.
  struct Images {
    cv::Mat depth;       ///< m; NaN where there is none
    cv::Mat confidence;  ///< see fillGaps
  };
  /// With the gaps between the points of a surface filled; leaves the buffer empty for the next image.
  Images takeFilled(const GapFillingParams& params);
  /// The depth as it is.
  [[nodiscard]] cv::Mat image();

 private:
  void join();

  SparseDepth recent_, older_;
  ImagePool pool_;
};

}  // namespace atlas
