// SPDX-License-Identifier: MIT
// Two cameras as a rectified pair. What their camera_info and their places say decides:
// - already rectified: no lens distortion, no rotation, the same K; the baseline stands in P (as ROS has it:
//   P[3] = -f * baseline of the right camera) or is the distance between the frames. Images pass untouched.
// - camera_info with R and P of a calibration of the pair: images are resampled by them.
// - else R and P are computed from K, the lenses and the place of the right camera (Bouguet's method in
//   OpenCV's stereoRectify), which must be known.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "atlas/base/geometry.hpp"
#include "atlas/sensor/sensor.hpp"
#include "atlas/stereo/stereo_rig.hpp"

namespace atlas {

class Rectifier {
 public:
  /// `T_left_right`: of the optical frames. Throws std::invalid_argument that says why two cameras make no
  /// pair: sizes differ, one camera twice, one above the other, left and right exchanged, place unknown, a
  /// lens that is not supported.
  Rectifier(const CameraInfo& left, const CameraInfo& right, const std::optional<Pose>& T_left_right);

  [[nodiscard]] const StereoRig& rig() const { return rig_; }
  /// Images need no resampling.
  [[nodiscard]] bool untouched() const { return left_.x.empty(); }
  [[nodiscard]] cv::Mat left(const cv::Mat& image) const { return resampled(image, left_); }
  [[nodiscard]] cv::Mat right(const cv::Mat& image) const { return resampled(image, right_); }

 private:
  struct Map {
    cv::Mat x, y;  ///< where in the camera's image each rectified pixel is; empty: where it is
  };
  void passUntouched(const CameraInfo& left, double baseline_m);
  void rectify(const CameraInfo& left, const CameraInfo& right, const Pose& T_left_right);
  void useOwnRectification(const CameraInfo& left, const CameraInfo& right);
  static cv::Mat resampled(const cv::Mat& image, const Map& map);

  StereoRig rig_;
  Map left_, right_;
};

}  // namespace atlas
