// SPDX-License-Identifier: MIT
// Projection between the optical frame (x right, y down, z forward) and pixels of the unrectified image.
// Conventions of OpenCV (calib3d): plumb_bob k1 k2 p1 p2 k3, rational_polynomial + k4 k5 k6, equidistant
// (fisheye) k1..k4; the centre of the first pixel is (0, 0).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "atlas/base/outcome.hpp"
#include "atlas/camera/distortion.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

class CameraModel {
 public:
  /// kMissingIntrinsics when size or focal length is zero; kNotFinite for a NaN; kBadLayout for an unknown
  /// model, a wrong coefficient count (none at all means no distortion), skew, or a size beyond 65535.
  static Outcome<CameraModel> fromInfo(const CameraInfo& info);

  /// Pixel of a point in the optical frame; nullopt behind the camera or where the distortion has folded back
  /// (beyond the largest angle at which it still grows). Not limited to the image: see inImage().
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera) const;
  /// Undistorted bearing (x/z, y/z, 1) of a pixel; nullopt where the inverse does not converge.
  [[nodiscard]] std::optional<Eigen::Vector3d> bearing(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] bool inImage(const Eigen::Vector2d& px) const {
    return px.x() >= -0.5 && px.y() >= -0.5 && px.x() < width_ - 0.5 && px.y() < height_ - 0.5;
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] double fx() const { return fx_; }
  [[nodiscard]] double fy() const { return fy_; }
  [[nodiscard]] double cx() const { return cx_; }
  [[nodiscard]] double cy() const { return cy_; }
  [[nodiscard]] const Distortion<double>& distortion() const { return distortion_; }
  /// Largest tan(angle off axis) whose projection is valid.
  [[nodiscard]] double maxTangent() const { return max_tangent_; }

 private:
  [[nodiscard]] std::optional<Eigen::Vector2d> undistortPolynomial(const Eigen::Vector2d& distorted) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> undistortFisheye(const Eigen::Vector2d& distorted) const;

  double fx_ = 0, fy_ = 0, cx_ = 0, cy_ = 0;
  Distortion<double> distortion_;
  int width_ = 0, height_ = 0;
  double max_tangent_ = 0;
};

}  // namespace atlas
