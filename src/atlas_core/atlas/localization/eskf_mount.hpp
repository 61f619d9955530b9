// SPDX-License-Identifier: MIT
// Which way the imu's x axis points on the vehicle, and with it the heading of the imu, from two views of the
// same change of velocity: the fixes see it along and across the course, the imu along and across its x axis.
// Speeding up, braking and centripetal acceleration all turn by the same angle m:
//
//   a_imu = exp(i m) a_course      (complex, level)      m = arg sum a_imu conj(a_course)
//
// A constant error of the tilt or of the accelerometer adds to a_imu what left and right turns, speeding up
// and braking average out. An acceleration that lasts is mistaken for tilt, and little of it is left in
// a_imu. Both show in |sum| against the larger of sum |a_imu|^2 and sum |a_course|^2: it is as large when
// both views agree in size and turn by one angle. A car that reverses has m = 180 degrees.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <complex>
#include <optional>

namespace atlas::eskf {

class MountYaw {
 public:
  /// Time passes; back: what turns a vector of the imu frame before into the present one.
  void move(const Eigen::Quaterniond& back, const Eigen::Vector3d& force_mps2, double dt_s);
  /// The velocity of the fixes alone, variance of its worse axis; up: unit, imu frame. After every fix.
  void velocity(const Eigen::Vector3d& v_map, double variance, const Eigen::Vector3d& up_imu);
  /// From imu x to the direction of driving, about up, rad; none until enough was seen.
  [[nodiscard]] std::optional<double> angle() const;

 private:
  Eigen::Vector3d impulse_imu_ = Eigen::Vector3d::Zero();  ///< of the force since v0
  Eigen::Vector3d v0_ = Eigen::Vector3d::Zero();
  double v0_variance_ = 0.0, span_s_ = 0.0;
  bool begun_ = false;
  std::complex<double> sum_ = 0.0;
  double imu_squares_ = 0.0, course_squares_ = 0.0;  ///< (m/s)^2
};

}  // namespace atlas::eskf
