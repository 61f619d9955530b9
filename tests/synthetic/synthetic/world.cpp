// SPDX-License-Identifier: MIT
#include "synthetic/world.hpp"

#include <cmath>
#include <stdexcept>

namespace atlas::synthetic {
namespace {

void require(bool good, const std::string& field, double value, const std::string& rule) {
  if (!good)
    throw std::invalid_argument("DriveOptions: " + field + " must be " + rule + ", got " +
                                std::to_string(value));
}

const DriveOptions& checked(const DriveOptions& options) {
  validate(options);
  return options;
}

}  // namespace

void validate(const DriveOptions& options) {
  require(options.duration_s >= 0.5 && options.duration_s <= 3600.0, "duration_s", options.duration_s,
          "in [0.5, 3600]");
  require(options.skip_s >= 0.0 && options.skip_s <= 3600.0, "skip_s", options.skip_s, "in [0, 3600]");
  require(options.stop_at_s >= 0.0 && options.stop_at_s <= 3600.0, "stop_at_s", options.stop_at_s,
          "in [0, 3600]");
  require(options.stop_for_s >= 0.0 && options.stop_for_s <= 3600.0, "stop_for_s", options.stop_for_s,
          "in [0, 3600]");
  require(options.rgb_scale >= 0.05 && options.rgb_scale <= 1.0, "rgb_scale", options.rgb_scale,
          "in [0.05, 1]");
  require(options.truth_points_every >= 0, "truth_points_every", options.truth_points_every, ">= 0");
  require(options.truth_depth_every >= 0, "truth_depth_every", options.truth_depth_every, ">= 0");
  require(options.imu_latency_s >= 0.0 && options.imu_latency_s < 1.0, "imu_latency_s", options.imu_latency_s,
          "in [0, 1)");
  require(options.gnss_latency_s >= 0.0 && options.gnss_latency_s < 1.0, "gnss_latency_s",
          options.gnss_latency_s, "in [0, 1)");
}

World::World(const DriveOptions& options)
    : options_(checked(options)),
      ego_(options.skip_s + options.duration_s + 1.0,
           normalGravity(options.anchor.latitude_deg, options.anchor.altitude_m),
           {options.stop_at_s, options.stop_for_s}),
      scene_(options.seed, ego_, options.skip_s + options.duration_s + 1.0),
      enu_(options.anchor) {
  T_map_city_.rotation = Eigen::AngleAxisd(options.street_yaw_rad, Eigen::Vector3d::UnitZ());
  T_map_city_.translation = -(T_map_city_.rotation * ego_.T_city_imu(0.0).translation);
}

}  // namespace atlas::synthetic
