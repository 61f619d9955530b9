// SPDX-License-Identifier: MIT
// Errors of de-skewed points against the truth of a synthetic drive, by the way of de-skewing and by what the
// car did: distortion is what is left after the best rigid motion of the scan, error in map is with the pose.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "atlas/base/geodesy.hpp"
#include "atlas/lidar/deskew_trial.hpp"
#include "atlas/lidar/vehicle_motion.hpp"

namespace atlas::synthetic {

class DeskewErrors {
 public:
  /// `run_anchor` is the origin of the run's map, `motion` its poses; both must outlive this.
  DeskewErrors(std::filesystem::path truth, const Geodetic& run_anchor, const VehicleMotion& motion);

  /// Scan `index` of a lidar, if there is truth for it; only what stands still counts.
  void add(const std::string& lidar, int index, const SweepPtr& sweep, const Pose& T_imu_lidar);

  /// A table for people, and the same as JSON: {motion: {way: {...}}}.
  void print(nlohmann::ordered_json& json) const;

 private:
  struct Errors {
    std::vector<float> distortion_m, in_map_m, settled_m;  ///< by point; settled: after 5 s of driving
  };
  [[nodiscard]] std::string motionAt(Stamp stamp) const;

  std::filesystem::path truth_;
  Pose T_truth_run_;
  const VehicleMotion& motion_;
  Stamp settled_ = 0;
  std::map<std::string, std::map<DeskewWay, Errors>> errors_;  ///< by motion
};

}  // namespace atlas::synthetic
