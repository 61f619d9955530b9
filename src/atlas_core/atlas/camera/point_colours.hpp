// SPDX-License-Identifier: MIT
// Places with the colour that a camera has seen there: every pixel of a depth image that a lidar has measured
// and that is left after the removal of hidden points, with the pixel of the picture of the same stamp. What
// the camera could not see gets no colour from it.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "atlas/base/geometry.hpp"
#include "atlas/camera/camera_model.hpp"

namespace atlas {

struct ColouredPoint {
  float x = 0, y = 0, z = 0;  ///< m, map
  float depth_m = 0;          ///< from the camera: the nearer, the truer
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// Bearings of the pixels of one camera: undistorting costs more than all the rest, and most pixels are asked
/// for again.
class PixelBearings {
 public:
  explicit PixelBearings(const CameraModel& model)
      : model_(model), tangents_(model.height(), model.width(), CV_32FC2, cv::Scalar::all(kUnknown)) {}
  PixelBearings(const PixelBearings&) = delete;  // a copied cv::Mat is the same pixels
  PixelBearings& operator=(const PixelBearings&) = delete;

  [[nodiscard]] cv::Size size() const { return tangents_.size(); }
  /// (x/z, y/z) in the optical frame; NaN where the lens has none.
  [[nodiscard]] cv::Vec2f at(int row, int column);

 private:
  static constexpr float kUnknown = 1e9F;
  CameraModel model_;
  cv::Mat tangents_;
};

/// `bgr`: CV_8UC3; `depth`, `confidence`: as the depth stage makes them; all three of bearings.size(). In
/// order of rows. T_map_camera: of the optical frame at the stamp of the picture.
[[nodiscard]] std::vector<ColouredPoint> pointColours(const cv::Mat& bgr, const cv::Mat& depth,
                                                      const cv::Mat& confidence, const Pose& T_map_camera,
                                                      PixelBearings& bearings);

}  // namespace atlas
