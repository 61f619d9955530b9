// SPDX-License-Identifier: MIT
// What the returns around the vehicle belong to at an instant, and where the objects are: what obstacles are
// judged by.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "synthetic/evaluate.hpp"
#include "synthetic/plan_box.hpp"

namespace atlas::synthetic {

/// Owners of returns beside the ids of objects.
constexpr int kOwnerGround = -1, kOwnerStructure = 0;

struct OwnedPoint {
  Eigen::Vector3d p;  ///< true map
  int owner;
};
struct TrueObject {
  Stamp stamp = 0;
  int class_id = 0;
  PlanBox box;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s
};

class ObstacleTruth {
 public:
  /// Throws std::runtime_error when truth/meta.json does not tell how the drive was made.
  explicit ObstacleTruth(const RunFolders& folders);
  /// Of the first lidar by name: the run answers each of them.
  [[nodiscard]] const std::vector<Stamp>& stamps() const { return stamps_; }
  /// Returns of the newest scan of each lidar; nothing when one of them has no truth.
  [[nodiscard]] std::optional<std::vector<OwnedPoint>> pointsAt(Stamp stamp) const;
  /// Objects by id: those of the nearest row of objects.csv, moved by their velocity.
  [[nodiscard]] std::map<int, TrueObject> objectsAt(Stamp stamp) const;
  /// Where the vehicle is; nothing outside the drive.
  [[nodiscard]] std::optional<Eigen::Vector2d> vehicleAt(Stamp stamp) const;

 private:
  RunFolders folders_;
  Pose T_city_map_;  ///< the ground is known in the city's frame
  std::vector<Stamp> stamps_;
  std::map<std::string, std::map<int, Stamp>> scans_;  ///< stamp by index, by lidar
  std::map<Stamp, std::map<int, TrueObject>> objects_;
  std::vector<StampedPose> trajectory_;
};

}  // namespace atlas::synthetic
