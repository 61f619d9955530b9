// SPDX-License-Identifier: MIT
// The double correlation as it was published (Perrollaz, Labayrade, Gallen, Aubert 2007): sums of absolute
// differences in a square window, the same for both hypotheses, over all disparities in the image as it is
// and over those around the road's in the view of the road. The hypothesis with the lesser cost says what the
// pixel is and how far. What is compared is the horizontal gradient, which does not know the cameras'
// exposure.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "atlas/stereo/disparity_choice.hpp"
#include "atlas/stereo/disparity_image.hpp"

namespace atlas {

struct WindowParams {
  int side_px = 11;  ///< of the window, odd, 3..31
  ChoiceParams choice{15, 1};
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const WindowParams& params);

struct WindowMatch {
  cv::Mat disparity;  ///< CV_32SC1, 1/256 px, or kNoDisparity
  cv::Mat surface;    ///< CV_8UC1 of SurfaceLabel
};

/// Keeps its buffers between images of one size. Not for use by two threads at once.
class WindowMatcher {
 public:
  /// Disparities 0 <= d < range_px, at most 256.
  WindowMatcher(cv::Size size, int range_px, const WindowParams& params);
  ~WindowMatcher();

  /// `left`, `right`: CV_8UC1; `road`: null when it is unknown.
  WindowMatch match(const cv::Mat& left, const cv::Mat& right, const RoadProfile* road);

 private:
  class Frontal;
  template <int Lanes>
  class FrontalOf;
  class Road;
  cv::Size size_;
  std::unique_ptr<Frontal> frontal_;
  std::unique_ptr<Road> road_;
};

}  // namespace atlas
