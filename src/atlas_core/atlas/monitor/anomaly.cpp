// SPDX-License-Identifier: MIT
#include "atlas/monitor/anomaly.hpp"

#include <cstdio>

namespace atlas {
namespace {

constexpr auto kAbove = AnomalyInfo::kAbove;
constexpr auto kBelow = AnomalyInfo::kBelow;

constexpr const char *kAll = "all", *kImu = "imu", *kMag = "magnetometer", *kBaro = "barometer",
                     *kGnss = "GNSS", *kCamera = "camera", *kThermal = "thermal camera", *kLidar = "lidar",
                     *kRadar = "radar";

// In the order of the enumeration.
constexpr std::array<AnomalyInfo, kAnomalies> kTable = {{
    {kAll, "missing", "missing_s", "s", kAbove, 0.5, 1.0,
     "time without a message; sensors slower than 10 Hz may be silent for five periods"},
    {kAll, "gap", "gap_periods", "periods", kAbove, 1.7, 0.2,
     "interval between two messages; from 2 on at least one is lost or late"},
    {kAll, "duplicate", "duplicate_messages", "messages", kAbove, 0.0, 0.1,
     "messages with the stamp of their predecessor"},
    {kAll, "misordered", "misordered_messages", "messages", kAbove, 0.0, 0.2,
     "messages with a stamp before that of their predecessor"},
    {kAll, "rate", "rate_change", "share", kAbove, 0.25, 0.3,
     "rate over 4 s against the usual one of the first messages"},
    {kAll, "not_finite", "not_finite_messages", "messages", kAbove, 0.0, 0.3,
     "messages with NaN or infinity"},
    {kAll, "clock_jump", "clock_jump_ms", "ms", kAbove, 100.0, 0.2,
     "step of the stamps against the sensor's own clock"},
    {kAll, "clock_drift", "clock_drift_ms", "ms", kAbove, 20.0, 0.3,
     "smallest delay of a second against that of the first second, by the sensor's own clock"},
    {kImu, "frozen", "imu_frozen_s", "s", kAbove, 0.2, 0.9, "time with six values that do not change at all"},
    {kImu, "accelerometer_saturated", "accelerometer_range_mps2", "m/s^2", kAbove, 0.0, 0.5,
     "largest acceleration; 0: the range is learned from values that repeat at the largest magnitude"},
    {kImu, "gyroscope_saturated", "gyroscope_range_radps", "rad/s", kAbove, 0.0, 0.5,
     "largest turn rate; 0: learned, too"},
    {kImu, "implausible", "implausible_samples", "samples", kAbove, 0.0, 0.8,
     "samples beyond 200 m/s^2 or 40 rad/s"},
    {kImu, "wrong_units", "wrong_units_samples", "samples", kAbove, 0.0, 1.0,
     "units or axes that cannot be right: g, degrees, gravity pointing down"},
    {kImu, "gravity", "gravity_mps2", "m/s^2", kAbove, 1.0, 0.6,
     "norm of the mean acceleration over 2 s against 9.81; a car that brakes hard reaches 0.5"},
    {kImu, "gyro_bias_jump", "gyro_bias_jump_radps", "rad/s", kAbove, 0.01, 0.5,
     "mean turn rate over 1 s while the receiver sees the vehicle stand, against earlier ones"},
    {kMag, "frozen", "magnetic_frozen_s", "s", kAbove, 0.5, 0.9, "time with the same three values"},
    {kMag, "magnetic_norm", "magnetic_norm_change", "share", kAbove, 0.3, 0.4,
     "norm of the mean field of 1 s against its mean over a minute"},
    {kBaro, "frozen", "pressure_frozen_s", "s", kAbove, 5.0, 0.9, "time with the same value"},
    {kBaro, "pressure_step", "pressure_step_pa", "Pa", kAbove, 300.0, 0.5,
     "step between two samples; 12 Pa are a metre"},
    {kGnss, "no_position", "no_position_fixes", "fixes", kAbove, 0.0, 1.0,
     "fixes with latitude and longitude exactly 0"},
    {kGnss, "frozen", "fix_frozen_s", "s", kAbove, 3.0, 0.5,
     "time with the same position to the last digit; some receivers hold it while they stand"},
    {kGnss, "position_jump", "position_jump_m", "m", kAbove, 2.0, 0.8,
     "distance from the motion before, beyond what noise (as the receiver states it) and 6 m/s^2 explain"},
    {kGnss, "position_sigma", "position_sigma_m", "m", kAbove, 5.0, 0.6,
     "horizontal standard deviation that the receiver gives"},
    {kGnss, "heading_lost", "heading_lost_s", "s", kAbove, 1.0, 0.2,
     "time without a heading, of a receiver that had one"},
    {kGnss, "heading_jump", "heading_jump_rad", "rad", kAbove, 0.35, 0.4,
     "step of the heading beyond a turn of 1.5 rad/s"},
    {kCamera, "empty", "empty_pictures", "pictures", kAbove, 0.0, 1.0, "pictures without pixels"},
    {kCamera, "frozen", "picture_frozen_s", "s", kAbove, 0.5, 0.9,
     "time with the same picture, unless the receiver sees the vehicle stand"},
    {kCamera, "black", "black_level", "grey", kBelow, 10.0, 0.9, "98th percentile of the grey values"},
    {kCamera, "white", "white_level", "grey", kAbove, 245.0, 0.9, "2nd percentile of the grey values"},
    {kCamera, "blurred", "blurred_sharpness", "share", kBelow, 0.33, 0.5,
     "largest step of a pixel as share of the rise over 4 pixels at edges: 1 = sharp, 0.25 = a ramp"},
    {kCamera, "fogged", "fogged_contrast", "grey", kBelow, 50.0, 0.6,
     "98th minus 2nd percentile of the grey values, where neither black nor white"},
    {kCamera, "glare", "glare_share", "share", kAbove, 0.2, 0.3,
     "overexposed part of the lower two thirds of the picture"},
    {kCamera, "occluded", "occluded_share", "share", kAbove, 0.12, 0.5,
     "part of a bright picture that is dark and without texture for a second; not of thermal cameras (sky)"},
    {kThermal, "range_frozen", "temperature_range_frozen_s", "s", kAbove, 5.0, 0.5,
     "time with the same temperatures of grey 0 and 255"},
    {kThermal, "range_implausible", "temperature_range_degc", "deg C", kAbove, 300.0, 0.8,
     "magnitude of a temperature, or an upper one below the lower"},
    {kLidar, "empty", "empty_scans", "scans", kAbove, 0.0, 1.0, "scans without a return"},
    {kLidar, "frozen", "scan_frozen_s", "s", kAbove, 0.0, 0.9, "time with the same points"},
    {kLidar, "few_points", "few_points_share", "share", kBelow, 0.5, 0.6,
     "returns as share of the usual number"},
    {kLidar, "dead_beams", "dead_beams", "beams", kAbove, 0.0, 0.1,
     "beams without returns over 1 s between beams that have them; those in dead_rings are known"},
    {kLidar, "blocked", "blocked_deg", "deg", kAbove, 15.0, 0.4,
     "directions that lost four fifths of their usual returns beyond 1 m for three scans"},
    {kLidar, "range_offset", "range_offset_m", "m", kAbove, 0.4, 0.4,
     "median difference of the nearest surface in each direction against the other lidar, mean of 1 s"},
    {kRadar, "frozen", "targets_frozen_s", "s", kAbove, 0.5, 0.9, "time with the same targets"},
}};

}  // namespace

const AnomalyInfo& infoOf(Anomaly anomaly) { return kTable.at(static_cast<std::size_t>(anomaly)); }

AnomalyThresholds::AnomalyThresholds() {
  for (std::size_t i = 0; i < kAnomalies; ++i) values_[i] = kTable[i].threshold;
}

std::string anomalyTable() {
  std::string text =
      "| sensor | anomaly | when | parameter | severity | quantity |\n|---|---|---|---|---|---|\n";
  for (const AnomalyInfo& info : kTable) {
    char row[600];
    std::snprintf(row, sizeof row, "| %s | `%s` | %s %g %s | `%s` | %g | %s |\n", info.sensors, info.name,
                  info.side == kAbove ? "above" : "below", info.threshold, info.unit, info.parameter,
                  info.severity, info.explanation);
    text += row;
  }
  return text;
}

}  // namespace atlas
