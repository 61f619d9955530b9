// SPDX-License-Identifier: MIT
// A KITTI Velodyne HDL-64E file (x, y, z, reflectance as float32) with what it does not store: ring and time.
// The file is laser by laser, top beam first, azimuth increasing within a laser: ring = 63 - number of
// azimuth wraps. The sensor turns clockwise seen from above and the sweep is cut at the rear: t = t_forward -
// az / (2 pi) * period with az = atan2(y, x). Order of points is the file's.
#pragma once

#include <string_view>

#include "atlas/sensor/sensor.hpp"

namespace atlas::record {

struct KittiSpin {
  static constexpr double kPeriod_s =
      0.10356;        ///< measured on drive 2011_09_26_drive_0057: 103.56 ms +- 0.05 ms
  Stamp forward = 0;  ///< when the sensor looks forward (and the cameras are triggered)
  double period_s = kPeriod_s;
  /// End of the sweep, which is its stamp.
  [[nodiscard]] Stamp end() const { return forward + fromSeconds(period_s / 2); }
};

/// nullopt when the bytes are no whole number of points or no point at all.
std::optional<Sweep> parseKittiSweep(std::string_view bytes, const KittiSpin& spin);

}  // namespace atlas::record
