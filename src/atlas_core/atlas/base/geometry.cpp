// SPDX-License-Identifier: MIT
#include "atlas/base/geometry.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace atlas {

Pose interpolate(const Pose& a, const Pose& b, double ratio) {
  if (!(ratio >= 0.0 && ratio <= 1.0)) {
    throw std::invalid_argument("interpolate: ratio must lie in [0, 1], got " + std::to_string(ratio));
  }
  return {a.rotation.slerp(ratio, b.rotation), a.translation + ratio * (b.translation - a.translation)};
}

RollPitchYaw toRollPitchYaw(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d r = q.toRotationMatrix();
  const double sin_pitch =
      std::min(1.0, std::max(-1.0, -r(2, 0)));  // rounding only: |r(2,0)| <= 1 for a unit q
  return {std::atan2(r(2, 1), r(2, 2)), std::asin(sin_pitch), std::atan2(r(1, 0), r(0, 0))};
}

Eigen::Quaterniond fromRollPitchYaw(const RollPitchYaw& rpy) {
  return Eigen::AngleAxisd(rpy.yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy.pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.roll, Eigen::Vector3d::UnitX());
}

double wrapAngle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * M_PI);
  return wrapped <= -M_PI ? wrapped + 2.0 * M_PI : wrapped;
}

Eigen::Quaterniond expSo3(const Eigen::Vector3d& rotation_vector_rad) {
  const double angle = rotation_vector_rad.norm();
  // sin(x/2)/x, by its series where the quotient loses digits
  const double scale = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = scale * rotation_vector_rad;
  return q;
}

Eigen::Vector3d logSo3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // q and -q are one rotation; take the short way
  const double sin_half = q.vec().norm();
  const double half = std::atan2(sin_half, sign * q.w());
  const double scale = sin_half < 1e-9 ? 2.0 : 2.0 * half / sin_half;
  return sign * scale * q.vec();
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace atlas
