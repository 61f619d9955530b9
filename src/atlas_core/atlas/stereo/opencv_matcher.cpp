// SPDX-License-Identifier: MIT
#include "atlas/stereo/opencv_matcher.hpp"

#include <cstdlib>

namespace atlas {
namespace {

constexpr int kOpencvScale = 16;  // counts a pixel
constexpr int kRangeStep = 16;    // OpenCV wants a multiple
constexpr int kRoadShare = 8;     // heights below this share of the camera's are road
constexpr int kRoadNoise = 256;   // and differences below this, 1/256 px

int wholeSteps(int range_px) { return (range_px + kRangeStep - 1) / kRangeStep * kRangeStep; }

}  // namespace

cv::Ptr<cv::StereoMatcher> opencvSgbm(int range_px) {
  constexpr int kBlock = 5, kCap = 63, kUniqueness = 10, kSpeckle = 100, kSpeckleRange = 2, kLeftRight = 1;
  return cv::StereoSGBM::create(0, wholeSteps(range_px), kBlock, 8 * kBlock * kBlock, 32 * kBlock * kBlock,
                                kLeftRight, kCap, kUniqueness, kSpeckle, kSpeckleRange,
                                cv::StereoSGBM::MODE_SGBM_3WAY);
}

cv::Ptr<cv::StereoMatcher> opencvBm(int range_px) {
  auto matcher = cv::StereoBM::create(wholeSteps(range_px), 15);
  matcher->setSpeckleWindowSize(100);
  matcher->setSpeckleRange(2);
  matcher->setDisp12MaxDiff(1);
  return matcher;
}

DisparityMethod::Match OpencvMethod::match(const cv::Mat& left, const cv::Mat& right,
                                           const RoadProfile* road) {
  cv::Mat found;
  matcher_->compute(left, right, found);
  Match result{cv::Mat(left.size(), CV_32SC1), cv::Mat(left.size(), CV_8UC1)};
  for (int v = 0; v < found.rows; ++v) {
    const std::int16_t* from = found.ptr<std::int16_t>(v);
    std::int32_t* disparity = result.disparity.ptr<std::int32_t>(v);
    std::uint8_t* surface = result.surface.ptr<std::uint8_t>(v);
    const double road_px = road == nullptr ? -1.0 : road->disparityAt(v);
    for (int u = 0; u < found.cols; ++u) {
      disparity[u] = from[u] < 0 ? kNoDisparity : from[u] * (kDisparityScale / kOpencvScale);
      const int away = std::abs(disparity[u] - static_cast<int>(road_px * kDisparityScale));
      const bool is_road = road_px >= 0.0 && away <= kRoadNoise + disparity[u] / kRoadShare;
      const SurfaceLabel label = is_road ? SurfaceLabel::kRoad : SurfaceLabel::kObstacle;
      surface[u] = static_cast<std::uint8_t>(from[u] < 0 ? SurfaceLabel::kUnknown : label);
    }
  }
  return result;
}

}  // namespace atlas
