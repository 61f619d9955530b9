// SPDX-License-Identifier: MIT
// Which returns of a sweep are believed: the vehicle's own body is too near, noise is too far. A return that
// is not believed becomes NaN and keeps its place, because the place of a point in its sweep says when it was
// measured.
#pragma once

#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct GatedSweep {
  SweepPtr sweep;         ///< the input itself when nothing had to change
  std::size_t gated = 0;  ///< finite points that became NaN
};

/// Points whose distance from the lidar lies outside [min_range_m, max_range_m], and points at exactly (0, 0,
/// 0) (how many drivers write "no return"), become NaN in a copy; a point with one coordinate that is not
/// finite becomes NaN in all three.
[[nodiscard]] GatedSweep gateByRange(const SweepPtr& sweep, double min_range_m, double max_range_m);

}  // namespace atlas
