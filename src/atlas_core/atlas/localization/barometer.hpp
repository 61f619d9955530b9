// SPDX-License-Identifier: MIT
// Height from air pressure, to hold the vertical while there are no fixes. Only changes count: while fixes
// are taken, the offset to the filter's height follows slowly (weather, ventilation, speed of the air around
// the sensor); without fixes it stays.
//
//   h = 44330.77 m (1 - (p / 101325 Pa)^0.190263)      ICAO standard atmosphere, troposphere
//   error: sigma, correlation time T; heights dt apart as white noise of the same density: sigma^2 2 T / dt
#pragma once

#include <optional>

#include "atlas/base/counters.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct BarometerParams {
  bool barometer = false;                ///< listen to imu/pressure; needs the filter "eskf"
  double barometer_sigma_m = 1.0;        ///< slow error of the height
  double barometer_error_time_s = 60.0;  ///< its correlation time T
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const BarometerParams& params);

/// ICAO standard height of a pressure, m.
double pressureHeight(double pressure_pa);

class Barometer {
 public:
  struct Height {
    double z_map_m, variance_m2;  ///< of the imu in map
  };
  /// `counters` must outlive it.
  Barometer(const BarometerParams& params, Counters& counters) : params_(params), counters_(counters) {}
  /// z_map_m: the filter's height; none: unknown. fixed: fixes are being taken. The height to be used, if
  /// any.
  std::optional<Height> add(const ScalarSample& pressure, std::optional<double> z_map_m, bool fixed);

 private:
  BarometerParams params_;
  Counters& counters_;
  std::optional<double> offset_m_;  ///< pressure height minus z
  Stamp last_ = kBeginOfTime, given_ = kBeginOfTime;
};

}  // namespace atlas
