// SPDX-License-Identifier: MIT
// When the points of a sweep were measured, where the sensor or its driver leaves it open: clouds without a
// time of their own, and stamps that mark another end of the sweep than the times say.
#pragma once

#include <string>
#include <vector>

#include "atlas/base/outcome.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// How long a sweep lasts that does not say so: 10 Hz, the usual rate.
constexpr double kAssumedSweep_s = 0.1;

/// A driver's raw time field as seconds relative to the stamp. Whole numbers count ns. Of floating types the
/// unit follows from the largest: all within 1 s of the stamp or beyond 1e9 is absolute (Unix time in s, ms,
/// us or ns), up to 1 are s, 1e3 ms, 1e6 us, 1e9 ns. Values that are not finite become NaN.
[[nodiscard]] std::vector<float> relativeTimes(const std::vector<double>& raw, bool whole_numbers,
                                               Stamp stamp);

/// What the times of a sweep without any were rebuilt from.
enum class TimeOrigin {
  kAzimuth,  ///< column by column: the azimuth runs once around
  kLasers,   ///< laser by laser, as in KITTI: the azimuth runs around once per laser
  kOrder     ///< no rotation to be seen: linear in the order of the points
};
const char* toString(TimeOrigin origin);

/// Fills `time` so that the sweep ends at its stamp and a turn takes `turn_s`. Column by column the direction
/// of rotation is seen from the points. Laser by laser the order does not tell it: the sensor is taken to
/// turn clockwise seen from above, as all common ones do, and the sweep to be cut at the rear (-x), as
/// KITTI's. Points without a return get the time of the one before them.
TimeOrigin rebuildTimes(std::vector<LidarPoint>& points, double turn_s);

/// Which moment of a sweep its stamp marks.
enum class ScanStamp {
  kRecorded,  ///< the one that the times of the points say
  kStart,     ///< the first point, whatever the times say
  kEnd        ///< the last point, whatever the times say
};
/// "recorded", "start", "end"; throws std::invalid_argument naming the value otherwise.
ScanStamp scanStampNamed(const std::string& name);

/// The sweep with all times shifted so that its stamp marks that moment; the sweep itself when nothing has to
/// change. Times that are not finite stay as they are.
[[nodiscard]] SweepPtr withStampAt(const SweepPtr& sweep, ScanStamp marks);

}  // namespace atlas
