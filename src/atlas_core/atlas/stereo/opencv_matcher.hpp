// SPDX-License-Identifier: MIT
// OpenCV's block matchers behind the same interface, for comparison.
#pragma once

#include <opencv2/calib3d.hpp>

#include "atlas/stereo/stereo_matcher.hpp"

namespace atlas {

/// Semi-global block matching in its fastest mode (three directions), with the usual parameters for roads.
cv::Ptr<cv::StereoMatcher> opencvSgbm(int range_px);
/// Block matching.
cv::Ptr<cv::StereoMatcher> opencvBm(int range_px);

class OpencvMethod : public DisparityMethod {
 public:
  explicit OpencvMethod(cv::Ptr<cv::StereoMatcher> matcher) : matcher_(std::move(matcher)) {}
  Match match(const cv::Mat& left, const cv::Mat& right, const RoadProfile* road) override;

 private:
  cv::Ptr<cv::StereoMatcher> matcher_;
};

}  // namespace atlas
