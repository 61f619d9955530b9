// SPDX-License-Identifier: MIT
#include "record/kitti_rows.hpp"

#include <cmath>

namespace atlas::record {

std::optional<Stamp> parseKittiStamp(std::string_view text) {
  text = trim(text);
  if (text.size() < 19 || text[4] != '-' || text[7] != '-' || text[10] != ' ' || text[13] != ':' ||
      text[16] != ':')
    return std::nullopt;
  const auto part = [&text](std::size_t at, std::size_t size) { return toUnsigned(text.substr(at, size)); };
  std::uint64_t nanosecond = 0;
  if (text.size() > 19) {
    std::string digits(text.substr(20));
    if (text[19] != '.' || digits.empty() || digits.size() > 9) return std::nullopt;
    digits.resize(9, '0');
    const auto value = toUnsigned(digits);
    if (!value) return std::nullopt;
    nanosecond = *value;
  }
  const auto year = part(0, 4), month = part(5, 2), day = part(8, 2), hour = part(11, 2),
             minute = part(14, 2), second = part(17, 2);
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const auto i = [](std::uint64_t v) { return static_cast<std::int64_t>(v); };
  const auto stamp =
      fromCalendar(i(*year), i(*month), i(*day), i(*hour), i(*minute), i(*second), i(nanosecond));
  return stamp && isPlausible(*stamp) ? stamp : std::nullopt;
}

std::map<std::uint32_t, Stamp> readKittiStamps(const std::filesystem::path& path, const std::string& name,
                                               RecordLog& log) {
  std::map<std::uint32_t, Stamp> stamps;
  LineReader lines(path);
  RowFields fields(name, ',');
  while (const auto line = lines.next()) {
    if (isBlank(line->text)) continue;
    ++log.file(name).rows;
    const auto stamp = parseKittiStamp(line->text);
    if (stamp) {
      stamps[static_cast<std::uint32_t>(line->number - 1)] = *stamp;
      continue;
    }
    fields.assign(*line);
    fields.fail("not a time", "field 1 (stamp): not a time: '" + std::string(line->text.substr(0, 40)) + "'");
    log.skip(name, fields.reason(), fields.example());
  }
  return stamps;
}

OxtsSample parseOxts(RowFields& fields, Stamp stamp) {
  OxtsSample sample;
  if (!fields.expectAtLeast(30)) return sample;
  sample.imu.stamp = sample.fix.stamp = sample.heading.stamp = stamp;
  Geodetic& p = sample.fix.position;
  p.latitude_deg = fields.number(0, "lat");
  p.longitude_deg = fields.number(1, "lon");
  p.altitude_m = fields.number(2, "alt");
  RollPitchYaw rpy;
  rpy.roll = fields.number(3, "roll");
  rpy.pitch = fields.number(4, "pitch");
  rpy.yaw = fields.number(5, "yaw");
  const char* const names[] = {"ax", "ay", "az", "wx", "wy", "wz"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    sample.imu.linear_acceleration_mps2[axis] = fields.number(11 + i, names[i]);
    sample.imu.angular_velocity_radps[axis] = fields.number(17 + i, names[3 + i]);
  }
  const double accuracy_m = fields.number(23, "pos_accuracy");
  if (!fields.ok()) return sample;
  if (std::abs(p.latitude_deg) > 90.0 || std::abs(p.longitude_deg) > 180.0) {
    fields.fail("position out of range", "fields 1, 2 (lat, lon): " + std::to_string(p.latitude_deg) + ", " +
                                             std::to_string(p.longitude_deg));
  }
  if (accuracy_m > 0) {
    // pos_accuracy is the standard deviation north/east; the file gives none for up: twice as large, as usual
    // for GNSS.
    const double horizontal = accuracy_m * accuracy_m, vertical = 4.0 * horizontal;
    sample.fix.covariance_enu_m2 = {horizontal, 0, 0, 0, horizontal, 0, 0, 0, vertical};
  }
  sample.fix.frame = "base_link";  // OXTS positions are those of the unit itself
  sample.imu.orientation = fromRollPitchYaw(rpy);
  sample.heading.yaw_rad = wrapAngle(rpy.yaw);
  return sample;
}

}  // namespace atlas::record
