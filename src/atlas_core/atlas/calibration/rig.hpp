// SPDX-License-Identifier: MIT
// Where the sensors sit on the vehicle. Filled from tf_static; a stage never reads a calibration file.
#pragma once

#include <map>
#include <string>

#include "atlas/base/outcome.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

class Rig {
 public:
  /// Adds or replaces transforms; chains are resolved when asked for.
  void add(const StaticTransforms& transforms);
  /// T_imu_sensor; kMissingFrame when the tree does not connect `frame` with base_link (alias: imu).
  [[nodiscard]] Outcome<Pose> T_imu(const std::string& frame) const;
  [[nodiscard]] bool empty() const { return parent_of_.empty(); }
  void clear() { parent_of_.clear(); }

 private:
  std::map<std::string, StaticTransform> parent_of_;  ///< by child
};

}  // namespace atlas
