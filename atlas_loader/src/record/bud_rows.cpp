// SPDX-License-Identifier: MIT
#include "record/bud_rows.hpp"

#include <cmath>

namespace atlas::record {
namespace {
constexpr double kPi = 3.14159265358979323846;

Eigen::Vector3d vector3(RowFields& fields, std::size_t first, const char* x, const char* y, const char* z) {
  const double vx = fields.number(first, x);
  const double vy = fields.number(first + 1, y);
  return {vx, vy, fields.number(first + 2, z)};
}
}  // namespace

ImuSample parseImu(RowFields& fields, const BudRowOptions& options) {
  ImuSample sample;
  if (!fields.expect(11)) return sample;
  sample.stamp = fields.stamp(0) - options.latency;
  sample.linear_acceleration_mps2 = vector3(fields, 1, "ax", "ay", "az");
  if (options.invert_acceleration) sample.linear_acceleration_mps2 *= -1.0;
  sample.angular_velocity_radps = vector3(fields, 4, "wx", "wy", "wz");
  const Eigen::Vector3d xyz = vector3(fields, 7, "qx", "qy", "qz");
  const Eigen::Quaterniond q(fields.number(10, "qw"), xyz.x(), xyz.y(), xyz.z());
  if (fields.ok() && std::abs(q.norm() - 1.0) < 0.05) sample.orientation = q.normalized();
  return sample;
}

MagneticSample parseMagnetic(RowFields& fields, const BudRowOptions& options) {
  MagneticSample sample;
  if (!fields.expect(4)) return sample;
  sample.stamp = fields.stamp(0) - options.latency;
  sample.field = vector3(fields, 1, "mx", "my", "mz");
  return sample;
}

ScalarSample parseScalar(RowFields& fields, const BudRowOptions& options, const char* name) {
  ScalarSample sample;
  if (!fields.expect(2)) return sample;
  sample.stamp = fields.stamp(0) - options.latency;
  sample.value = fields.number(1, name);
  return sample;
}

TimeReference parseTime(RowFields& fields, const BudRowOptions& options, const std::string& source) {
  TimeReference reference;
  if (!fields.expect(8)) return reference;
  reference.stamp = fields.stamp(0) - options.latency;
  reference.sensor_time = fields.calendar(1);
  reference.source = source;
  return reference;
}

GnssFix parseFix(RowFields& fields, const BudRowOptions& options, std::size_t columns) {
  GnssFix fix;
  fix.frame = columns == 5
                  ? "gnss_rear"
                  : "base_link";  // the receiver's rear antenna; the IMU's own receiver: place unknown
  if (!fields.expect(columns)) return fix;
  fix.stamp = fields.stamp(0) - options.latency;
  fix.position.latitude_deg = fields.number(1, "lat");
  fix.position.longitude_deg = fields.number(2, "lon");
  fix.position.altitude_m = fields.number(3, "alt");
  const Geodetic& p = fix.position;
  if (fields.ok() && (std::abs(p.latitude_deg) > 90.0 || std::abs(p.longitude_deg) > 180.0)) {
    fields.fail("position out of range", "fields 2, 3 (lat, lon): " + std::to_string(p.latitude_deg) + ", " +
                                             std::to_string(p.longitude_deg));
  }
  if (fields.ok() && p.latitude_deg == 0.0 && p.longitude_deg == 0.0) {
    fields.fail("no position", "fields 2, 3 (lat, lon): both exactly 0");
  }
  return fix;
}

std::optional<GnssHeading> parseHeading(RowFields& fields, const BudRowOptions& options) {
  const Stamp stamp = fields.stamp(0) - options.latency;
  const double azimuth_deg = fields.number(4, "azimuth");
  if (fields.ok() && std::abs(azimuth_deg) > 360.0) {
    fields.fail("azimuth out of range", "field 5 (azimuth): " + std::to_string(azimuth_deg) + " deg");
  }
  if (!fields.ok() || azimuth_deg == 0.0) return std::nullopt;
  GnssHeading heading;
  heading.stamp = stamp;
  heading.yaw_rad = wrapAngle(kPi / 2.0 - azimuth_deg * kPi / 180.0);
  return heading;
}

RadarScan parseRadar(RowFields& fields, const BudRowOptions& options) {
  RadarScan scan;
  if (!fields.expectAtLeast(2)) return scan;
  scan.stamp = fields.stamp(0) - options.latency;
  const auto count = static_cast<std::size_t>(fields.integer(1, "targets", 0, 100'000));
  if (!fields.ok() || !fields.expect(2 + 4 * count)) return scan;
  for (std::size_t i = 0; i < count; ++i) {
    RadarTarget target;
    target.position = vector3(fields, 2 + 4 * i, "x", "y", "z");
    target.radial_velocity_mps = fields.number(5 + 4 * i, "vel");
    scan.targets.push_back(target);
  }
  return scan;
}

}  // namespace atlas::record
