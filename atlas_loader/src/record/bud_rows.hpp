// SPDX-License-Identifier: MIT
// The row formats of the Brno Urban Dataset (one function a file). Column 1 is the system stamp, Unix ns.
// A fault is left in `fields`; the returned value then means nothing.
#pragma once

#include "atlas/sensor/sensor.hpp"
#include "record/text_rows.hpp"

namespace atlas::record {

struct BudRowOptions {
  Duration latency = 0;              ///< subtracted from the stamp
  bool invert_acceleration = false;  ///< outcome of the gravity test
};

/// imu/imu.txt: ts, ax, ay, az [m/s^2], wx, wy, wz [rad/s], qx, qy, qz, qw. The orientation is normalized; it
/// is absent when its norm is off by more than 5 % (printed with 6 digits, a real one is off by 1e-6).
ImuSample parseImu(RowFields& fields, const BudRowOptions& options);
/// imu/mag.txt: ts, mx, my, mz in the sensor's normalized unit.
MagneticSample parseMagnetic(RowFields& fields, const BudRowOptions& options);
/// imu/pressure.txt (Pa) and imu/temp.txt (deg C): ts, value.
ScalarSample parseScalar(RowFields& fields, const BudRowOptions& options, const char* name);
/// imu/time.txt and gnss/time.txt: ts, Y, M, D, h, m, s, ns (UTC).
TimeReference parseTime(RowFields& fields, const BudRowOptions& options, const std::string& source);
/// imu/gnss.txt: ts, lat, lon, alt; gnss/pose.txt has `columns` = 5.
GnssFix parseFix(RowFields& fields, const BudRowOptions& options, std::size_t columns);
/// gnss/pose.txt: ts, lat, lon, alt, azimuth [deg, clockwise from north; exactly 0 = none -> nullopt].
std::optional<GnssHeading> parseHeading(RowFields& fields, const BudRowOptions& options);
/// radar_ti/scans.txt: ts, n, then n x (x, y, z [m], vel [m/s]).
RadarScan parseRadar(RowFields& fields, const BudRowOptions& options);

}  // namespace atlas::record
