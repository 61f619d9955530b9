// SPDX-License-Identifier: MIT
#include "synthetic/drive.hpp"

#include <cstdio>

#include "synthetic/camera_record.hpp"
#include "synthetic/inertial.hpp"
#include "synthetic/lidar.hpp"
#include "synthetic/rig.hpp"
#include "synthetic/scan_files.hpp"
#include "synthetic/text_file.hpp"
#include "synthetic/truth.hpp"
#include "synthetic/world.hpp"

namespace atlas::synthetic {
namespace {

using Path = std::filesystem::path;
using Progress = std::function<void(const std::string&, double)>;

constexpr Duration kSystemDelay =
    477'000;  // ns from the lidar's own clock to the system stamp, as in the real record

/// Seconds in the high half, microseconds of the hour in the low half.
std::uint64_t innerLidarTime(Stamp stamp) {
  const Stamp own = stamp - kSystemDelay;
  const auto seconds = static_cast<std::uint64_t>(own / kSecond);
  const auto of_hour_us = static_cast<std::uint64_t>(own % (3600 * kSecond) / 1000);
  return seconds << 32U | of_hour_us;
}

std::uint64_t writeLidar(const World& world, const std::string& name, const Path& record,
                         const Progress& progress) {
  const DriveOptions& options = world.options();
  Lidar lidar(world, name);
  ScanWriter scans(record / name, options.scans_zip);
  TextFile timestamps(record / name / "timestamps.txt", TextFile::LineEnd::kDos);
  int index = 0;
  for (; lidar.nextStamp() < world.end(); ++index) {
    const bool with_truth = options.truth_points_every > 0 && index % options.truth_points_every == 0;
    const LidarScan scan = lidar.next(with_truth);
    scans.write(index, scan.points);
    timestamps.print("%lld,%d, %llu\n", static_cast<long long>(scan.stamp), index,
                     static_cast<unsigned long long>(innerLidarTime(scan.stamp)));
    char file[32];
    std::snprintf(file, sizeof file, "%06d.bin", index);
    if (with_truth) writeTruthPoints(record / "truth" / "points" / name / file, scan.truth);
    if (progress) progress(name, toSeconds(scan.stamp - options.start) / options.duration_s);
  }
  scans.close();
  return static_cast<std::uint64_t>(index);
}

}  // namespace

DriveCounts writeDrive(const DriveOptions& options, const Path& record, const Progress& progress) {
  const World world(options);
  std::filesystem::create_directories(record);
  writeCalibrations(record / "calibrations", options.rgb_scale);
  writeTruth(world, record / "truth");
  if (progress) progress("trajectory", 1.0);
  writeImu(world, record / "imu");
  writeGnss(world, record / "gnss");
  writeRadar(world, record / "radar_ti");
  if (progress) progress("imu, gnss, radar", 1.0);
  DriveCounts counts;
  counts["imu"] = imuStamps(world).size();
  if (options.lidar) {
    for (const char* name : {"lidar_left", "lidar_right"})
      counts[name] = writeLidar(world, name, record, progress);
  }
  for (const std::string& name : options.cameras) counts[name] = writeCamera(world, name, record, progress);
  return counts;
}

}  // namespace atlas::synthetic
