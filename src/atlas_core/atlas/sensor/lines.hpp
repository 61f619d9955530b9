// SPDX-License-Identifier: MIT
// Straight lines that the lasers of a lidar draw on what they meet.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atlas/base/geometry.hpp"
#include "atlas/base/time.hpp"

namespace atlas {

enum class LineKind : std::uint8_t {
  kSurface,  ///< on what stands on the ground: walls, kerbs' faces, vehicles
  kRoad,     ///< on the ground; where it is flat, a laser draws an arc and these are its chords
  kMarking   ///< where the trace of a laser crosses something bright and narrow on the ground
};
const char* toString(LineKind kind);

struct Line {
  LineKind kind = LineKind::kSurface;
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  ///< m, map
  std::uint16_t ring = 0;                                                        ///< laser
  std::uint32_t points = 0;                                                      ///< returns on it
  double rms_m = 0;      ///< of their distances from it; 0 for markings
  double intensity = 0;  ///< mean, as recorded
};
struct Lines {
  Stamp stamp = 0;    ///< of the sweep
  std::string frame;  ///< of the lidar that drew them
  std::vector<Line> lines;
};

}  // namespace atlas
