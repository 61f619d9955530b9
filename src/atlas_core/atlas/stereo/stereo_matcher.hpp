// SPDX-License-Identifier: MIT
// Disparities of a rectified pair, and what each pixel is part of, by one of several methods:
// - double_correlation, along paths: matched at half the size (path_matcher.hpp), refined at the whole one;
// - double_correlation in windows: as it was published (window_matcher.hpp);
// - sgbm, bm: OpenCV's, for comparison. They know no road: what is near its disparity is labelled so.
// The road is that of the camera's height and pitch when they are given. Else it is fitted to the disparities
// of each image (road_fit.hpp); an image is matched with the road of the one before, the first one twice.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "atlas/stereo/disparity_image.hpp"
#include "atlas/stereo/path_matcher.hpp"
#include "atlas/stereo/road_fit.hpp"
#include "atlas/stereo/stereo_rig.hpp"
#include "atlas/stereo/window_matcher.hpp"

namespace atlas {

struct StereoParams {
  std::string method = "double_correlation";  ///< or sgbm, bm
  std::string aggregation = "paths";          ///< of double_correlation; or window
  int range_px = 64;                          ///< disparities 0 <= d < range_px; nearer things are not seen
  int speckle_px = 400;  ///< smaller patches whose disparity is not that of what is around are removed
  double camera_height_m = 0.0;   ///< above the road; 0: the road is looked for in the images
  double camera_pitch_deg = 0.0;  ///< down; of camera_height_m
  PathParams paths;
  WindowParams window;
  RoadFitParams road;
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const StereoParams& params);

/// One method. Not for use by two threads at once.
class DisparityMethod {
 public:
  struct Match {
    cv::Mat disparity;  ///< CV_32SC1, 1/256 px, or kNoDisparity
    cv::Mat surface;    ///< CV_8UC1 of SurfaceLabel
  };
  virtual ~DisparityMethod() = default;
  /// `left`, `right`: CV_8UC1 of the rig's size; `road`: null when it is unknown. Valid until the next call.
  virtual Match match(const cv::Mat& left, const cv::Mat& right, const RoadProfile* road) = 0;
};

/// The pairs of one rig in the order they were taken. Not for use by two threads at once.
class StereoMatcher {
 public:
  StereoMatcher(const StereoRig& rig, const StereoParams& params);
  ~StereoMatcher();

  /// Rectified images of the rig's size, 8 or 16 bit, grey or colour (BGR, BGRA). Throws
  /// std::invalid_argument that says which image is missing or of another size.
  DisparityImage match(const cv::Mat& left, const cv::Mat& right);
  /// Forgets the road: the next pair has nothing to do with the last one.
  void reset() { road_.reset(); }

 private:
  StereoRig rig_;
  StereoParams params_;
  std::unique_ptr<DisparityMethod> method_;
  std::optional<RoadProfile> road_;  ///< of the image before
};

}  // namespace atlas
