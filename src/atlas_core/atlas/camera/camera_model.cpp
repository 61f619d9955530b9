// SPDX-License-Identifier: MIT
#include "atlas/camera/camera_model.hpp"

#include <Eigen/LU>
#include <cmath>

namespace atlas {
namespace {

constexpr double kLargestTangent = 1000.0;  // 89.94 deg: what a lens without distortion may see
constexpr double kSearchStepRad = 0.25 * M_PI / 180.0;
constexpr int kSearchDirections = 32;  // tangential terms make the limit depend on the direction
constexpr std::uint32_t kLargestSidePx = 65535;

bool allFinite(const CameraInfo& info) {
  for (const double value : info.K) {
    if (!std::isfinite(value)) return false;
  }
  for (const double value : info.distortion) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

Outcome<Distortion<double>> distortionOf(const CameraInfo& info) {
  const std::size_t count = info.distortion.size();
  Distortion<double> result;
  if (info.distortion_model == "plumb_bob") {
    if (count != 0 && count != 4 && count != 5) return Reason::kBadLayout;
    result.kind = DistortionKind::kPolynomial;
  } else if (info.distortion_model == "rational_polynomial") {
    if (count != 0 && count != 8) return Reason::kBadLayout;
    result.kind = DistortionKind::kPolynomial;
  } else if (info.distortion_model == "equidistant") {
    if (count != 4) return Reason::kBadLayout;
    result.kind = DistortionKind::kFisheye;
  } else if (!info.distortion_model.empty() || count != 0) {
    return Reason::kBadLayout;
  }
  bool any = false;
  for (std::size_t i = 0; i < count; ++i) {
    result.k[i] = info.distortion[i];
    any = any || info.distortion[i] != 0.0;
  }
  if (!any && result.kind == DistortionKind::kPolynomial) result.kind = DistortionKind::kNone;
  return result;
}

// Jacobian of the polynomial distortion (see distortion.hpp for the model); it is symmetric.
Eigen::Matrix2d jacobian(const Distortion<double>& d, double x, double y) {
  const double s = x * x + y * y;
  const double f = d.radial(s), slope = d.radialSlope(s);
  const double p1 = d.k[2], p2 = d.k[3];
  const double mixed = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y;
  Eigen::Matrix2d j;
  j << f + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x, mixed,  //
      mixed, f + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return j;
}

// The distortion is one-to-one around (x, y): it neither mirrors nor folds.
bool grows(const Distortion<double>& d, double x, double y) {
  const double s = x * x + y * y;
  if (!(d.denominator(s) > 0.0) || !(d.radial(s) > 0.0)) return false;
  const Eigen::Matrix2d j = jacobian(d, x, y);
  return j.determinant() > 0.0 && j.trace() > 0.0;
}

bool growsAtAngle(const Distortion<double>& d, double angle_rad) {
  if (d.kind == DistortionKind::kFisheye) {
    return d.fisheyeSlope(angle_rad) > 0.0;
  }
  const double r = std::tan(angle_rad);
  for (int i = 0; i < kSearchDirections; ++i) {
    const double direction = 2.0 * M_PI * i / kSearchDirections;
    if (!grows(d, r * std::cos(direction), r * std::sin(direction))) return false;
  }
  return true;
}

// The largest angle up to which the distortion grows without a break, found by steps and then halving.
double findMaxTangent(const Distortion<double>& d) {
  const double end_rad = std::atan(kLargestTangent);
  if (d.kind == DistortionKind::kNone) return kLargestTangent;
  double good = 0.0;
  double bad = -1.0;
  while (bad < 0.0 && good < end_rad) {
    const double next = std::min(good + kSearchStepRad, end_rad);
    if (growsAtAngle(d, next)) {
      good = next;
    } else {
      bad = next;
    }
  }
  if (bad < 0.0) return kLargestTangent;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (good + bad);
    (growsAtAngle(d, middle) ? good : bad) = middle;
  }
  return std::tan(good);
}

}  // namespace

Outcome<CameraModel> CameraModel::fromInfo(const CameraInfo& info) {
  if (!allFinite(info)) return Reason::kNotFinite;
  if (info.width == 0 || info.height == 0 || info.K[0] <= 0.0 || info.K[4] <= 0.0)
    return Reason::kMissingIntrinsics;
  if (info.width > kLargestSidePx || info.height > kLargestSidePx || info.K[1] != 0.0)
    return Reason::kBadLayout;
  const Outcome<Distortion<double>> distortion = distortionOf(info);
  if (!distortion) return distortion.reason();
  CameraModel model;
  model.fx_ = info.K[0];
  model.fy_ = info.K[4];
  model.cx_ = info.K[2];
  model.cy_ = info.K[5];
  model.width_ = static_cast<int>(info.width);
  model.height_ = static_cast<int>(info.height);
  model.distortion_ = *distortion;
  model.max_tangent_ = findMaxTangent(*distortion);
  return model;
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& p_camera) const {
  if (!(p_camera.z() > 0.0)) return std::nullopt;
  double x = p_camera.x() / p_camera.z();
  double y = p_camera.y() / p_camera.z();
  if (!(x * x + y * y <= max_tangent_ * max_tangent_)) return std::nullopt;
  distortion_.apply(x, y);
  return Eigen::Vector2d(fx_ * x + cx_, fy_ * y + cy_);
}

std::optional<Eigen::Vector3d> CameraModel::bearing(const Eigen::Vector2d& pixel) const {
  if (!pixel.allFinite()) return std::nullopt;
  const Eigen::Vector2d distorted((pixel.x() - cx_) / fx_, (pixel.y() - cy_) / fy_);
  std::optional<Eigen::Vector2d> plain = distorted;
  if (distortion_.kind == DistortionKind::kPolynomial) plain = undistortPolynomial(distorted);
  if (distortion_.kind == DistortionKind::kFisheye) plain = undistortFisheye(distorted);
  if (!plain || plain->norm() > max_tangent_) return std::nullopt;
  return Eigen::Vector3d(plain->x(), plain->y(), 1.0);
}

// Newton with step halving: a step must stay in the region where the distortion grows, and must reduce the
// error.
std::optional<Eigen::Vector2d> CameraModel::undistortPolynomial(const Eigen::Vector2d& distorted) const {
  const auto error = [&](const Eigen::Vector2d& guess) {
    Eigen::Vector2d d = guess;
    distortion_.apply(d.x(), d.y());
    return Eigen::Vector2d(distorted - d);
  };
  const double tolerance = 1e-12 * (1.0 + distorted.norm());  // 1e-9 px
  Eigen::Vector2d guess = distorted;
  if (guess.norm() > 0.95 * max_tangent_) guess *= 0.95 * max_tangent_ / guess.norm();
  Eigen::Vector2d e = error(guess);
  for (int i = 0; i < 50; ++i) {
    if (e.norm() <= tolerance) return guess;
    const Eigen::Vector2d step = jacobian(distortion_, guess.x(), guess.y()).inverse() * e;
    double share = 1.0;
    bool better = false;
    for (int halvings = 0; halvings < 30 && !better; ++halvings, share *= 0.5) {
      const Eigen::Vector2d next = guess + share * step;
      if (!next.allFinite() || next.norm() > max_tangent_) continue;
      const Eigen::Vector2d next_error = error(next);
      if (!(next_error.norm() < e.norm())) continue;
      guess = next;
      e = next_error;
      better = true;
    }
    if (!better) return std::nullopt;
  }
  return std::nullopt;
}

// theta_d grows up to the limit, so the angle lies between 0 and it: halving never fails where there is a
// solution.
std::optional<Eigen::Vector2d> CameraModel::undistortFisheye(const Eigen::Vector2d& distorted) const {
  const double wanted = distorted.norm();
  if (wanted <= 1e-12) return distorted;
  double low = 0.0;
  double high = std::atan(max_tangent_);
  if (distortion_.fisheyeAngle(high) < wanted) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (distortion_.fisheyeAngle(middle) < wanted ? low : high) = middle;
  }
  return Eigen::Vector2d(distorted * (std::tan(0.5 * (low + high)) / wanted));
}

}  // namespace atlas
