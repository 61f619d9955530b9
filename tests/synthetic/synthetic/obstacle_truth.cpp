// SPDX-License-Identifier: MIT
#include "synthetic/obstacle_truth.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "synthetic/ground.hpp"
#include "synthetic/record_files.hpp"
#include "synthetic/scan_files.hpp"
#include "synthetic/world.hpp"

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr double kAboveGround_m = 0.05;  ///< what is lower is ground
constexpr Stamp kRevolution = 110 * kMillisecond;

Pose cityOfDrive(const fs::path& meta_json) {
  std::ifstream file(meta_json);
  const auto meta = nlohmann::json::parse(file, nullptr, false);
  DriveOptions options;
  if (!meta.is_object() || !meta.contains("skip_s") || !meta.contains("duration_s") ||
      !meta.contains("street_yaw_rad"))
    throw std::runtime_error(meta_json.string() + ": no skip_s, duration_s and street_yaw_rad of a drive");
  options.skip_s = meta["skip_s"].get<double>();
  options.duration_s = meta["duration_s"].get<double>();
  options.street_yaw_rad = meta["street_yaw_rad"].get<double>();
  return World(options).T_map_city();
}

std::map<Stamp, std::map<int, TrueObject>> readObjects(const fs::path& csv) {
  std::map<Stamp, std::map<int, TrueObject>> objects;
  std::ifstream file(csv);
  for (std::string line; std::getline(file, line);) {
    TrueObject o;
    long long stamp = 0;
    int id = 0;
    double z = 0, height = 0;
    if (std::sscanf(line.c_str(), "%lld,%d,%d,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &stamp, &id, &o.class_id,
                    &o.box.center.x(), &o.box.center.y(), &z, &o.box.yaw_rad, &o.box.length, &o.box.width,
                    &height, &o.velocity.x(), &o.velocity.y()) != 12)
      continue;
    o.stamp = stamp;
    objects[stamp][id] = o;
  }
  return objects;
}

}  // namespace

ObstacleTruth::ObstacleTruth(const RunFolders& folders)
    : folders_(folders),
      T_city_map_(cityOfDrive(folders.truth / "meta.json").inverse()),
      objects_(readObjects(folders.truth / "objects.csv")),
      trajectory_(readTrajectory(folders.truth / "trajectory.tum")) {
  for (const std::string& lidar : foldersOf(folders.truth / "points"))
    scans_[lidar] = readFrameStamps(folders.record / lidar / "timestamps.txt");
  if (scans_.empty()) return;
  for (const auto& [index, stamp] : scans_.begin()->second) stamps_.push_back(stamp);
}

std::optional<std::vector<OwnedPoint>> ObstacleTruth::pointsAt(Stamp stamp) const {
  std::vector<OwnedPoint> result;
  for (const auto& [lidar, stamps] : scans_) {
    int newest = -1;
    for (const auto& [index, scan] : stamps) {
      if (scan <= stamp && scan > stamp - kRevolution) newest = index;
    }
    if (newest < 0) return std::nullopt;
    char name[32];
    std::snprintf(name, sizeof name, "%06d.bin", newest);
    const std::vector<TruthPoint> points = readTruthPoints(folders_.truth / "points" / lidar / name);
    if (points.empty()) return std::nullopt;
    for (const TruthPoint& point : points) {
      if (!std::isfinite(point.x)) continue;
      const Eigen::Vector3d p(point.x, point.y, point.z), in_city = T_city_map_ * p;
      // the face of a kerb is ground too
      const double ground_m = roadSurface(in_city.x(), in_city.y()).height + kKerbHeight + kAboveGround_m;
      const int owner = point.object != 0.0F      ? static_cast<int>(point.object)
                        : in_city.z() <= ground_m ? kOwnerGround
                                                  : kOwnerStructure;
      result.push_back({p, owner});
    }
  }
  return result;
}

std::map<int, TrueObject> ObstacleTruth::objectsAt(Stamp stamp) const {
  if (objects_.empty()) return {};
  auto row = objects_.lower_bound(stamp);
  const bool before = row == objects_.end() ||
                      (row != objects_.begin() && row->first - stamp > stamp - std::prev(row)->first);
  if (before) --row;
  std::map<int, TrueObject> result = row->second;
  for (auto& [id, object] : result) object.box.center += toSeconds(stamp - object.stamp) * object.velocity;
  return result;
}

std::optional<Eigen::Vector2d> ObstacleTruth::vehicleAt(Stamp stamp) const {
  const auto next = std::lower_bound(trajectory_.begin(), trajectory_.end(), stamp,
                                     [](const StampedPose& pose, Stamp s) { return pose.stamp < s; });
  if (next == trajectory_.end()) return std::nullopt;
  return Eigen::Vector2d(next->pose.translation.head<2>());
}

}  // namespace atlas::synthetic
