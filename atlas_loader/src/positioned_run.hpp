// SPDX-License-Identifier: MIT
// Where the vehicle was during a recording, for programs that judge its sweeps: positioning alone, all poses
// kept in memory.
#pragma once

#include <optional>

#include "atlas/calibration/rig.hpp"
#include "atlas/lidar/vehicle_motion.hpp"
#include "atlas/localization/localization_stage.hpp"
#include "open_input.hpp"

namespace atlas_loader {

enum class PoseSource {
  kFiltered,  ///< the suite's positioning, as it knows the pose when it is asked
  kSmoothed,  ///< the same with the measurements after it
  kRecorded   ///< the recording's own: position of each fix, attitude of the IMU sample at the same stamp
};
/// "filtered", "smoothed", "recorded"; throws std::invalid_argument naming the value otherwise.
PoseSource poseSourceNamed(const std::string& name);

struct PositionedRun {
  atlas::VehicleMotion motion;
  atlas::Rig rig;
  std::optional<atlas::Geodetic> anchor;  ///< origin of map; nothing when there never was a pose
};

/// Without `velocities` the motion within a sweep is taken from the poses. Throws std::invalid_argument for a
/// filter without smoother, std::runtime_error for unreadable input.
PositionedRun positionRun(const InputOptions& input, const atlas::LocalizationParams& params,
                          PoseSource source, bool velocities = true);

}  // namespace atlas_loader
