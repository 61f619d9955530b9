// SPDX-License-Identifier: MIT
// One pose as one line of the usual trajectory formats. All lines end with \n, numbers have a decimal point
// in any locale.
#pragma once

#include <string>

#include "atlas/sensor/products.hpp"

namespace atlas {

/// Appends a number with a fixed count of decimals (0..9), "nan" or "inf" as such. Fast: lines come at IMU
/// rate.
void appendFixed(std::string& text, double value, int decimals);
/// "1568805602.123456789": seconds with nine decimals, exact.
void appendStampSeconds(std::string& text, Stamp stamp);

/// TUM RGB-D: "stamp x y z qx qy qz qw", T_map_imu.
[[nodiscard]] std::string tumLine(const Odometry& odometry);
/// KITTI odometry: the upper three rows of T_map_imu, row by row; no stamp.
[[nodiscard]] std::string kittiLine(const Odometry& odometry);
/// stamp_ns, pose, twist in the imu frame, upper triangle of the pose covariance (m^2, m rad, rad^2). See
/// csvTitle().
[[nodiscard]] std::string csvLine(const Odometry& odometry);
[[nodiscard]] std::string csvTitle();
/// What an odometry says about its own errors: stamp_ns, velocity (imu frame), then the upper triangles of
/// the covariances of position (map), velocity (imu frame) and attitude (small rotation about the axes of
/// map). m, s, rad. See covarianceTitle().
[[nodiscard]] std::string covarianceLine(const Odometry& odometry);
[[nodiscard]] std::string covarianceTitle();

}  // namespace atlas
