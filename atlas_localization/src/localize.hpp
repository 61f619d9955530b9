// SPDX-License-Identifier: MIT
// Positioning alone: an IMU and a GNSS receiver in plain CSV (csv_sensors.hpp) become trajectory.tum
// (filtered, at every IMU sample once everything is known), smoothed.tum, anchor.json and innovations.csv.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace atlas_localization {

struct LocalizeOptions {
  std::filesystem::path imu, gnss, out;
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< antenna in the imu frame
  std::string config;        ///< YAML with a section "localization"; "" = defaults
  std::string filter;        ///< overrides the configuration's; "" = not
  bool covariances = false;  ///< also trajectory_covariance.csv and smoothed_covariance.csv
};

/// What was read, used and written, as lines for the user.
struct LocalizeSummary {
  std::vector<std::string> lines;
  std::uint64_t poses = 0;
};

/// Throws std::invalid_argument for bad options, std::runtime_error for files that cannot be used, each with
/// a text that says what is wrong where. Nothing is written then.
LocalizeSummary localize(const LocalizeOptions& options);

}  // namespace atlas_localization
