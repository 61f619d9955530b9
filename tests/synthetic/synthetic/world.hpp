// SPDX-License-Identifier: MIT
// Motion, scene and the frames that tie them together for one drive.
#pragma once

#include "atlas/base/geodesy.hpp"
#include "synthetic/ego_motion.hpp"
#include "synthetic/options.hpp"
#include "synthetic/scene.hpp"

namespace atlas::synthetic {

class World {
 public:
  /// Validates the options.
  explicit World(const DriveOptions& options);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  [[nodiscard]] const DriveOptions& options() const { return options_; }
  [[nodiscard]] const EgoMotion& ego() const { return ego_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const LocalEnu& enu() const { return enu_; }
  [[nodiscard]] const Pose& T_map_city() const { return T_map_city_; }
  /// Seconds on the route at a stamp.
  [[nodiscard]] double routeTime(Stamp stamp) const {
    return toSeconds(stamp - options_.start) + options_.skip_s;
  }
  [[nodiscard]] Stamp end() const { return options_.start + fromSeconds(options_.duration_s); }
  [[nodiscard]] Pose T_city_imu(Stamp stamp) const { return ego_.T_city_imu(routeTime(stamp)); }
  [[nodiscard]] Pose T_map_imu(Stamp stamp) const { return T_map_city_ * T_city_imu(stamp); }

 private:
  DriveOptions options_;
  EgoMotion ego_;
  Scene scene_;
  LocalEnu enu_;
  Pose T_map_city_;
};

}  // namespace atlas::synthetic
