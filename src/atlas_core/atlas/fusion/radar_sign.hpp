// SPDX-License-Identifier: MIT
// Whether a radar's velocities grow with the distance (range rate) or against it: told by what stands still
// while the vehicle moves, as recordings do not say it.
#pragma once

#include <cstdint>
#include <optional>

namespace atlas {

class RadarSign {
 public:
  /// A target whose velocity would be `standing_mps` (away from the radar positive) if it stood still.
  void add(double recorded_mps, double standing_mps);
  /// 1: recorded velocities are positive for what moves away; -1: the other way; nothing before enough
  /// targets have voted clearly.
  [[nodiscard]] std::optional<double> sign() const;

 private:
  std::uint64_t away_ = 0, towards_ = 0;
};

}  // namespace atlas
