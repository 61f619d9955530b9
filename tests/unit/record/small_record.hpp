// SPDX-License-Identifier: MIT
// Small files of the Brno Urban Dataset's layout, one second each, for tests that then spoil one of them.
#pragma once

#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "atlas/base/time.hpp"
#include "temporary_folder.hpp"

namespace atlas::test {

constexpr Stamp kBegin = 1'568'186'745'400'000'000;

inline std::string stampText(Stamp stamp) { return std::to_string(stamp); }

/// Rows of `text(i)` at `begin + i * period`, each ended by `line_end`.
template <class Text>
std::string rows(int count, Duration period, Text text, const std::string& line_end = "\r\n",
                 Stamp begin = kBegin) {
  std::string out;
  for (int i = 0; i < count; ++i) out += stampText(begin + i * period) + text(i) + line_end;
  return out;
}

/// Standing, acceleration with the dataset's inverted sign; 400 Hz.
inline std::string imuText(int count, double az_mps2 = -9.81, Stamp begin = kBegin) {
  char row[160];
  std::snprintf(row, sizeof row, ", 0.01, -0.02, %.5f, 0.001, -0.002, 0.003, 0, 0, 0, 1", az_mps2);
  return rows(
      count, 2'500'000, [&](int) { return std::string(row); }, "\r\n", begin);
}

/// 20 Hz; every fifth row has no heading.
inline std::string poseText(int count) {
  return rows(count, 50 * kMillisecond, [](int i) {
    return ", 49.2281" + std::to_string(i % 10) + ", 16.57547959, 281.368, " + (i % 5 == 4 ? "0" : "63.5158");
  });
}

/// PCD of points x y z intensity, binary.
inline std::string pcdText(const std::vector<std::array<float, 4>>& points, int width = 0, int height = 1) {
  const std::string n = std::to_string(points.size());
  std::string text =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH " +
      (width > 0 ? std::to_string(width) : n) + "\nHEIGHT " + std::to_string(height) + "\nPOINTS " + n +
      "\nDATA binary\n";
  const std::size_t at = text.size();
  text.resize(at + points.size() * sizeof points[0]);
  if (!points.empty()) std::memcpy(text.data() + at, points.data(), points.size() * sizeof points[0]);
  return text;
}

/// A revolution of an HDL-32E in firing order: `columns` x 32 points at 10 m, clockwise, lasers from the
/// bottom up; laser `dead` and every 10th column without return.
inline std::vector<std::array<float, 4>> revolution(int columns, int dead = -1) {
  std::vector<std::array<float, 4>> points;
  for (int c = 0; c < columns; ++c) {
    for (int laser = 0; laser < 32; ++laser) {
      const double azimuth = -2.0 * M_PI * c / columns, elevation = (-30.67 + 1.3333 * laser) * M_PI / 180.0;
      const bool none = laser == dead || c % 10 == 9;
      points.push_back(none ? std::array<float, 4>{0, 0, 0, 0}
                            : std::array<float, 4>{
                                  static_cast<float>(10.0 * std::cos(elevation) * std::cos(azimuth)),
                                  static_cast<float>(10.0 * std::cos(elevation) * std::sin(azimuth)),
                                  static_cast<float>(10.0 * std::sin(elevation)), static_cast<float>(laser)});
    }
  }
  return points;
}

/// The inner clock of a BUD lidar: Unix seconds, and microseconds since the full hour.
inline std::uint64_t innerTime(Stamp stamp, std::int64_t second_error = 0) {
  const auto seconds = static_cast<std::uint64_t>(stamp / kSecond);
  const std::int64_t hour = 3600 * kSecond;
  return (seconds << 32) + static_cast<std::uint64_t>((stamp % hour) / 1000 + second_error * 1'000'000);
}

inline std::string lidarTimesText(int count, Duration period = 100 * kMillisecond) {
  return rows(count, period, [&](int i) {
    return "," + std::to_string(i) + ", " + std::to_string(innerTime(kBegin + i * period - 477'000));
  });
}

inline std::string scanName(int index) {
  char name[32];
  std::snprintf(name, sizeof name, "scan%06d.pcd", index);
  return name;
}

/// imu, gnss, lidar_left with ten scans in its folder, radar; no videos.
inline void writeSmallRecord(const TemporaryFolder& folder) {
  const auto scalar = [](const char* value) { return [value](int) { return std::string(", ") + value; }; };
  folder.write("imu/imu.txt", imuText(400));
  folder.write("imu/d_quat.txt", rows(400, 2'500'000, scalar("0, 0, 0, 1")));
  folder.write("imu/gnss.txt", rows(50, 20 * kMillisecond, scalar("49.22807312, 16.57549667, 0")));
  folder.write("imu/mag.txt", rows(100, 10 * kMillisecond, scalar("0.240066, 0.943281, -1.00343")));
  folder.write("imu/pressure.txt", rows(50, 20 * kMillisecond, scalar("98879")));
  folder.write("imu/temp.txt", rows(400, 2'500'000, scalar("29.0625")));
  folder.write("imu/time.txt", rows(400, 2'500'000, scalar("2019, 9, 11, 7, 25, 45, 403600000")));
  folder.write("gnss/pose.txt", poseText(20));
  folder.write("gnss/time.txt", rows(20, 50 * kMillisecond, scalar("2019, 9, 11, 7, 25, 45, 430000000")));
  folder.write("lidar_left/timestamps.txt", lidarTimesText(10));
  for (int i = 0; i < 10; ++i) folder.write("lidar_left/" + scanName(i), pcdText(revolution(60, 14)));
  folder.write("radar_ti/scans.txt",
               rows(5, 200 * kMillisecond, scalar("2, 10.5, 1, 0.5, -3.25, 20, -2, 0, 1e-1"), "\n"));
}

}  // namespace atlas::test
