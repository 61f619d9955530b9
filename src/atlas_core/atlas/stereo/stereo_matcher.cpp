// SPDX-License-Identifier: MIT
#include "atlas/stereo/stereo_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "atlas/stereo/census.hpp"
#include "atlas/stereo/opencv_matcher.hpp"
#include "atlas/stereo/refinement.hpp"
#include "atlas/stereo/road_view.hpp"

namespace atlas {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kSpeckleScale = 16;   // counts a pixel in what OpenCV's filter takes
constexpr int kSpeckleStep_px = 2;  // neighbours that differ by more are of two patches

[[noreturn]] void reject(const std::string& field, const std::string& need, const std::string& value) {
  throw std::invalid_argument("stereo: " + field + " must be " + need + ", got " + value);
}

/// Patches of fewer than `pixels` pixels become unknown.
void removeSpeckles(DisparityMethod::Match& match, int pixels, double step_px) {
  cv::Mat scaled;
  match.disparity.convertTo(scaled, CV_16S, static_cast<double>(kSpeckleScale) / kDisparityScale);
  scaled.setTo(-1, match.disparity < 0);
  cv::filterSpeckles(scaled, -1, pixels, step_px * kSpeckleScale);
  const cv::Mat gone = scaled < 0;
  match.disparity.setTo(kNoDisparity, gone);
  match.surface.setTo(static_cast<int>(SurfaceLabel::kUnknown), gone);
}

class PathMethod : public DisparityMethod {
 public:
  PathMethod(cv::Size size, const StereoParams& params)
      : full_(size, CV_32SC1),
        speckle_(params.speckle_px / 4),
        matcher_({(size.width + 1) / 2, (size.height + 1) / 2}, (params.range_px + 1) / 2, params.paths) {}

  Match match(const cv::Mat& left, const cv::Mat& right, const RoadProfile* road) override {
    const cv::Mat half_right = halved(right);
    std::optional<RoadCensus> of_road;
    if (road != nullptr) {
      const RoadProfile half_road = halved(*road);
      of_road = RoadCensus{censusOf(shearedByRoad(half_right, half_road)), half_road};
    }
    const PathMatch found =
        matcher_.match(censusOf(halved(left)), censusOf(half_right), of_road ? &*of_road : nullptr);
    Match half{found.disparity, found.surface};
    removeSpeckles(half, speckle_, 0.5 * kSpeckleStep_px);
    doubled(half.disparity, full_);
    refine(left, right, full_);
    return {full_, doubledLabels(half.surface)};
  }

 private:
  [[nodiscard]] cv::Mat doubledLabels(const cv::Mat& half) const {
    cv::Mat full(full_.size(), CV_8UC1);
    for (int v = 0; v < full.rows; ++v) {
      const std::uint8_t* from = half.ptr<std::uint8_t>(v / 2);
      std::uint8_t* to = full.ptr<std::uint8_t>(v);
      for (int u = 0; u < full.cols; ++u) to[u] = from[u / 2];
    }
    return full;
  }

  cv::Mat full_;  ///< kept from image to image: new memory costs more than what is done with it
  int speckle_;
  PathMatcher matcher_;
};

class WindowMethod : public DisparityMethod {
 public:
  WindowMethod(cv::Size size, const StereoParams& params)
      : speckle_(params.speckle_px), matcher_(size, params.range_px, params.window) {}
  Match match(const cv::Mat& left, const cv::Mat& right, const RoadProfile* road) override {
    const WindowMatch found = matcher_.match(left, right, road);
    Match result{found.disparity, found.surface};
    removeSpeckles(result, speckle_, kSpeckleStep_px);
    return result;
  }

 private:
  int speckle_;
  WindowMatcher matcher_;
};

std::unique_ptr<DisparityMethod> methodOf(const StereoRig& rig, const StereoParams& params) {
  const cv::Size size(rig.width_px, rig.height_px);
  if (params.method == "sgbm") return std::make_unique<OpencvMethod>(opencvSgbm(params.range_px));
  if (params.method == "bm") return std::make_unique<OpencvMethod>(opencvBm(params.range_px));
  if (params.aggregation == "window") return std::make_unique<WindowMethod>(size, params);
  return std::make_unique<PathMethod>(size, params);
}

void checkImage(const std::string& name, const cv::Mat& image, const StereoRig& rig) {
  if (image.empty()) throw std::invalid_argument("stereo: the " + name + " image is missing");
  if (image.depth() != CV_8U && image.depth() != CV_16U)
    throw std::invalid_argument("stereo: the " + name + " image must have 8 or 16 bit, got " +
                                cv::typeToString(image.type()));
  if (image.cols != rig.width_px || image.rows != rig.height_px)
    throw std::invalid_argument("stereo: the " + name + " image must be " + std::to_string(rig.width_px) +
                                "x" + std::to_string(rig.height_px) + " as its camera_info says, got " +
                                std::to_string(image.cols) + "x" + std::to_string(image.rows));
}

cv::Mat greyOf(const cv::Mat& image) {
  cv::Mat grey = image;
  if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  if (image.channels() == 4) cv::cvtColor(image, grey, cv::COLOR_BGRA2GRAY);
  return grey;
}

/// 16 bit images become 8 bit by one factor for both, as their cameras may use fewer bits.
void to8Bit(cv::Mat& left, cv::Mat& right) {
  double most = 0;
  for (const cv::Mat* image : {&left, &right}) {
    double of_image = 0;
    if (image->depth() == CV_16U) cv::minMaxLoc(*image, nullptr, &of_image);
    most = std::max(most, of_image);
  }
  for (cv::Mat* image : {&left, &right})
    if (image->depth() == CV_16U) image->convertTo(*image, CV_8U, 255.0 / std::max(most, 1.0));
}

/// Files and messages hold 16 bit; 0 is unknown, so what is infinitely far is the smallest number.
cv::Mat to16Bit(const cv::Mat& disparity) {
  cv::Mat result(disparity.size(), CV_16UC1);
  for (int v = 0; v < disparity.rows; ++v) {
    const std::int32_t* from = disparity.ptr<std::int32_t>(v);
    std::uint16_t* to = result.ptr<std::uint16_t>(v);
    for (int u = 0; u < disparity.cols; ++u)
      to[u] = static_cast<std::uint16_t>(from[u] < 0 ? 0 : std::clamp(from[u], 1, 65535));
  }
  return result;
}

}  // namespace

void validate(const StereoParams& params) {
  if (params.method != "double_correlation" && params.method != "sgbm" && params.method != "bm")
    reject("method", "double_correlation, sgbm or bm", "'" + params.method + "'");
  if (params.aggregation != "paths" && params.aggregation != "window")
    reject("aggregation", "paths or window", "'" + params.aggregation + "'");
  if (params.range_px < 8 || params.range_px > 256)
    reject("range_px", "in 8..256", std::to_string(params.range_px));
  if (params.speckle_px < 0) reject("speckle_px", "at least 0", std::to_string(params.speckle_px));
  if (!(params.camera_height_m >= 0.0 && std::isfinite(params.camera_height_m)))
    reject("camera_height_m", "0 or positive", std::to_string(params.camera_height_m));
  if (!(std::abs(params.camera_pitch_deg) < 45.0))
    reject("camera_pitch_deg", "in (-45, 45)", std::to_string(params.camera_pitch_deg));
  validate(params.paths);
  validate(params.window);
  validate(params.road);
}

StereoMatcher::StereoMatcher(const StereoRig& rig, const StereoParams& params) : rig_(rig), params_(params) {
  validate(rig);
  validate(params);
  if (params.range_px >= rig.width_px)
    reject("range_px", "less than the width of the image (" + std::to_string(rig.width_px) + ")",
           std::to_string(params.range_px));
  method_ = methodOf(rig, params);
}

StereoMatcher::~StereoMatcher() = default;

DisparityImage StereoMatcher::match(const cv::Mat& left, const cv::Mat& right) {
  checkImage("left", left, rig_);
  checkImage("right", right, rig_);
  cv::Mat left_grey = greyOf(left), right_grey = greyOf(right);
  to8Bit(left_grey, right_grey);
  const bool known = params_.camera_height_m > 0.0;
  if (known) road_ = roadFromCamera(rig_, params_.camera_height_m, params_.camera_pitch_deg * kDegree);
  DisparityMethod::Match match = method_->match(left_grey, right_grey, road_ ? &*road_ : nullptr);
  if (!known) {
    const bool first = !road_;
    road_ = fitRoad(match.disparity, rig_, params_.road, road_);
    if (first && road_) match = method_->match(left_grey, right_grey, &*road_);
    if (!road_) match.surface.setTo(static_cast<int>(SurfaceLabel::kObstacle), match.disparity >= 0);
  }
  return {to16Bit(match.disparity), match.surface, road_};
}

}  // namespace atlas
