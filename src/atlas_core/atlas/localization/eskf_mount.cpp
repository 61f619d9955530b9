// SPDX-License-Identifier: MIT
#include "atlas/localization/eskf_mount.hpp"

#include <algorithm>
#include <cmath>

namespace atlas::eskf {
namespace {
constexpr double kSpan_s = 1.0;  // long against the lag of the fixes' velocity, short against a manoeuvre
constexpr double kSureChange_sq = 16.0;  // a change of velocity counts beyond 4 standard deviations
constexpr double kMinSpeed_mps = 2.0;    // below it sway moves the antenna, too, and on foot a pole swings
constexpr double kEnough_mps_sq = 4.0;   // sum of the squares of all changes
constexpr double kLeastAgreement = 0.7;
}  // namespace

void MountYaw::move(const Eigen::Quaterniond& back, const Eigen::Vector3d& force_mps2, double dt_s) {
  impulse_imu_ = back * impulse_imu_ + dt_s * force_mps2;
  span_s_ += dt_s;
}

void MountYaw::velocity(const Eigen::Vector3d& v_map, double variance, const Eigen::Vector3d& up_imu) {
  if (begun_ && span_s_ < kSpan_s) return;
  const Eigen::Vector2d change = (v_map - v0_).head<2>();
  const double speed = v_map.head<2>().norm();
  if (begun_ && speed > kMinSpeed_mps && change.squaredNorm() > kSureChange_sq * (variance + v0_variance_)) {
    const Eigen::Vector3d x = (Eigen::Vector3d::UnitX() - up_imu.x() * up_imu).normalized();
    const std::complex<double> imu(impulse_imu_.dot(x), impulse_imu_.dot(up_imu.cross(x)));
    const std::complex<double> course =
        std::complex<double>(change.x(), change.y()) * std::complex<double>(v_map.x(), -v_map.y()) / speed;
    sum_ += imu * std::conj(course);
    imu_squares_ += std::norm(imu);
    course_squares_ += std::norm(course);
  }
  begun_ = true;
  span_s_ = 0.0;
  impulse_imu_.setZero();
  v0_ = v_map;
  v0_variance_ = variance;
}

std::optional<double> MountYaw::angle() const {
  if (course_squares_ < kEnough_mps_sq) return std::nullopt;
  if (std::abs(sum_) < kLeastAgreement * std::max(imu_squares_, course_squares_)) return std::nullopt;
  return std::arg(sum_);
}

}  // namespace atlas::eskf
