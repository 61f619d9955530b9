// SPDX-License-Identifier: MIT
#include "atlas/stereo/rectifier.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

namespace atlas {
namespace {

constexpr double kSame_px = 0.01;       // two numbers of a calibration in pixels are the same
constexpr double kSame = 1e-6;          // elements of a rotation
constexpr double kParallel_rad = 1e-3;  // 0.7 px at 720 px of focal length
constexpr double kLevel = 0.01;         // share of the baseline by which a rectified camera is off its line
constexpr double kSmallestBaseline_m = 1e-3;
constexpr double kWidestAngle_rad = 0.5;

[[noreturn]] void refuse(const CameraInfo& left, const CameraInfo& right, const std::string& why) {
  throw std::invalid_argument("stereo pair '" + left.frame + "', '" + right.frame + "': " + why);
}

cv::Mat matrixOf(const std::array<double, 9>& values) {
  return cv::Mat(3, 3, CV_64F, const_cast<double*>(values.data())).clone();
}

cv::Mat projectionOf(const std::array<double, 12>& values) {
  return cv::Mat(3, 4, CV_64F, const_cast<double*>(values.data())).clone();
}

cv::Mat distortionOf(const CameraInfo& info) { return cv::Mat(info.distortion, true); }

bool hasDistortion(const CameraInfo& info) {
  return std::any_of(info.distortion.begin(), info.distortion.end(), [](double d) { return d != 0.0; });
}

bool isIdentity(const std::array<double, 9>& rotation) {
  for (std::size_t k = 0; k < rotation.size(); ++k)
    if (std::abs(rotation[k] - (k % 4 == 0 ? 1.0 : 0.0)) > kSame) return false;
  return true;
}

bool sameIntrinsics(const CameraInfo& left, const CameraInfo& right) {
  for (std::size_t k = 0; k < left.K.size(); ++k)
    if (std::abs(left.K[k] - right.K[k]) > kSame_px) return false;
  return true;
}

/// Distance between the cameras in P, m; nullopt without (P empty, or of a camera on its own).
std::optional<double> baselineInP(const CameraInfo& left, const CameraInfo& right) {
  if (left.P[0] <= 0.0 || std::abs(left.P[0] - right.P[0]) > kSame_px ||
      std::abs(left.P[5] - right.P[5]) > kSame_px || std::abs(left.P[6] - right.P[6]) > kSame_px)
    return std::nullopt;
  const double baseline_m = (left.P[3] - right.P[3]) / left.P[0];
  if (std::abs(baseline_m) < kSmallestBaseline_m) return std::nullopt;
  return baseline_m;
}

void checkCameras(const CameraInfo& left, const CameraInfo& right) {
  for (const CameraInfo* info : {&left, &right}) {
    if (info->K[0] <= 0.0 || info->width == 0 || info->height == 0)
      refuse(left, right, "camera_info of '" + info->frame + "' has no focal length or size");
    if (info->distortion_model != "plumb_bob" && info->distortion_model != "rational_polynomial" &&
        hasDistortion(*info))
      refuse(left, right,
             "the lens model '" + info->distortion_model + "' of '" + info->frame +
                 "' is not supported: plumb_bob or rational_polynomial");
  }
  if (left.width != right.width || left.height != right.height)
    refuse(left, right,
           "sizes differ: " + std::to_string(left.width) + "x" + std::to_string(left.height) + " and " +
               std::to_string(right.width) + "x" + std::to_string(right.height));
  if (!left.frame.empty() && left.frame == right.frame) refuse(left, right, "both are the same camera");
}

/// The right camera must be on the right, and look the same way.
void checkPlace(const CameraInfo& left, const CameraInfo& right, const Pose& T_left_right) {
  const Eigen::Vector3d& place = T_left_right.translation;
  if (!(place.norm() >= kSmallestBaseline_m))
    refuse(left, right, "their places are " + std::to_string(place.norm()) + " m apart: no baseline");
  if (std::abs(place.y()) > std::abs(place.x()) || std::abs(place.z()) > std::abs(place.x()))
    refuse(left, right,
           "the right camera is at (" + std::to_string(place.x()) + ", " + std::to_string(place.y()) + ", " +
               std::to_string(place.z()) + ") m of the left one: they must stand side by side");
  if (place.x() < 0.0) refuse(left, right, "the right camera is on the left: exchange them");
  const double angle_rad = logSo3(T_left_right.rotation).norm();
  if (angle_rad > kWidestAngle_rad)
    refuse(left, right, "they look in directions " + std::to_string(angle_rad) + " rad apart");
}

}  // namespace

Rectifier::Rectifier(const CameraInfo& left, const CameraInfo& right,
                     const std::optional<Pose>& T_left_right) {
  checkCameras(left, right);
  rig_.width_px = static_cast<int>(left.width);
  rig_.height_px = static_cast<int>(left.height);
  const bool straight = !hasDistortion(left) && !hasDistortion(right) && isIdentity(left.R) &&
                        isIdentity(right.R) && sameIntrinsics(left, right);
  const auto baseline_m = baselineInP(left, right);
  if (baseline_m && *baseline_m < 0.0)
    refuse(left, right, "the right camera is on the left by P: exchange them");
  if (baseline_m) {
    const bool same_image = straight && std::abs(left.K[0] - left.P[0]) <= kSame_px &&
                            std::abs(left.K[2] - left.P[2]) <= kSame_px &&
                            std::abs(left.K[5] - left.P[6]) <= kSame_px;
    if (same_image)
      passUntouched(left, *baseline_m);
    else
      useOwnRectification(left, right);
    return;
  }
  if (!T_left_right)
    refuse(left, right, "not rectified: P has no baseline, and the place of the right camera is unknown");
  checkPlace(left, right, *T_left_right);
  const Eigen::Vector3d& place = T_left_right->translation;
  const bool level = std::abs(place.y()) <= kLevel * place.x() && std::abs(place.z()) <= kLevel * place.x();
  if (straight && level && logSo3(T_left_right->rotation).norm() <= kParallel_rad)
    passUntouched(left, place.x());
  else
    rectify(left, right, *T_left_right);
}

void Rectifier::passUntouched(const CameraInfo& left, double baseline_m) {
  rig_.focal_px = left.K[0];
  rig_.u0_px = left.K[2];
  rig_.v0_px = left.K[5];
  rig_.baseline_m = baseline_m;
  validate(rig_);
}

void Rectifier::rectify(const CameraInfo& left, const CameraInfo& right, const Pose& T_left_right) {
  const Pose T_right_left = T_left_right.inverse();
  const Eigen::Matrix3d rotation = T_right_left.rotation.toRotationMatrix();
  cv::Mat R(3, 3, CV_64F), T(3, 1, CV_64F), R1, R2, P1, P2, Q;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) R.at<double>(row, column) = rotation(row, column);
    T.at<double>(row) = T_right_left.translation[row];
  }
  constexpr double kOnlySeen = 0.0;  // no pixel of the rectified images lies outside those of the cameras
  const cv::Size size(rig_.width_px, rig_.height_px);
  cv::stereoRectify(matrixOf(left.K), distortionOf(left), matrixOf(right.K), distortionOf(right), size, R, T,
                    R1, R2, P1, P2, Q, cv::CALIB_ZERO_DISPARITY, kOnlySeen);
  CameraInfo rectified_left = left, rectified_right = right;
  std::copy_n(R1.ptr<double>(), 9, rectified_left.R.begin());
  std::copy_n(R2.ptr<double>(), 9, rectified_right.R.begin());
  std::copy_n(P1.ptr<double>(), 12, rectified_left.P.begin());
  std::copy_n(P2.ptr<double>(), 12, rectified_right.P.begin());
  useOwnRectification(rectified_left, rectified_right);
}

void Rectifier::useOwnRectification(const CameraInfo& left, const CameraInfo& right) {
  const cv::Size size(rig_.width_px, rig_.height_px);
  const auto mapOf = [&](const CameraInfo& info) {
    Map map;
    cv::initUndistortRectifyMap(matrixOf(info.K), distortionOf(info), matrixOf(info.R),
                                projectionOf(info.P).colRange(0, 3), size, CV_16SC2, map.x, map.y);
    return map;
  };
  left_ = mapOf(left);
  right_ = mapOf(right);
  rig_.focal_px = left.P[0];
  rig_.u0_px = left.P[2];
  rig_.v0_px = left.P[6];
  rig_.baseline_m = (left.P[3] - right.P[3]) / left.P[0];
  Eigen::Matrix3d R_rectified_left;
  for (int k = 0; k < 9; ++k) R_rectified_left(k / 3, k % 3) = left.R[static_cast<std::size_t>(k)];
  rig_.T_left_rectified.rotation = Eigen::Quaterniond(R_rectified_left.transpose()).normalized();
  validate(rig_);
}

cv::Mat Rectifier::resampled(const cv::Mat& image, const Map& map) {
  if (map.x.empty()) return image;
  cv::Mat result;
  cv::remap(image, result, map.x, map.y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return result;
}

}  // namespace atlas
