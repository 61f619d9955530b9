// SPDX-License-Identifier: MIT
// What a synthetic drive is made from. The record and its truth are a function of these values alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atlas/base/geodesy.hpp"
#include "atlas/base/time.hpp"

namespace atlas::synthetic {

/// Standard deviations of one sample, or of a slow Gauss-Markov process, unless said otherwise.
struct NoiseOptions {
  double gyro_density_radps_rthz = 0.01 * 0.017453292519943295;  ///< Xsens MTi-G-710 data sheet
  double gyro_turn_on_bias_radps = 0.1 * 0.017453292519943295;
  double gyro_instability_radps = 10.0 / 3600.0 * 0.017453292519943295;  ///< 10 deg/h, correlated over 100 s
  double accel_density_mps2_rthz = 80e-6 * 9.80665;
  double accel_turn_on_bias_mps2 = 0.02;
  double accel_instability_mps2 = 15e-6 * 9.80665;
  double orientation_rad =
      0.2 * 0.017453292519943295;  ///< roll and pitch of the IMU's own filter, slow (20 s)
  double magnetic_yaw_offset_rad =
      -21.1 * 0.017453292519943295;  ///< constant, as in the real sample (5.4 for 26.5 deg)
  double magnetic_yaw_rad = 1.0 * 0.017453292519943295;  ///< slow (30 s)
  double gnss_horizontal_m = 0.02;                       ///< each axis, white
  double gnss_vertical_m = 0.035;
  double heading_white_rad = 1.0 * 0.017453292519943295;
  double heading_slow_rad =
      1.0 * 0.017453292519943295;  ///< correlated over 8 s: about 3 deg of amplitude together
  double lidar_range_m = 0.02;
  double lidar_lost_fraction = 0.01;  ///< returns that are missing for no reason
  double detection_px = 1.0;          ///< each side of a box, at 960x600
  double detection_missed_fraction = 0.05;
};

struct DriveOptions {
  std::uint64_t seed = 1;
  double duration_s = 30.0;
  double skip_s = 0.0;  ///< the record begins this long after the start of the route
  double stop_at_s = 0.0,
         stop_for_s = 0.0;  ///< the first standstill from stop_at_s of the route on is longer
  double rgb_scale = 0.5;   ///< of 1920x1200
  bool video = true;        ///< false: no mp4 and no depth pictures; boxes and detections are still made
  bool lidar = true;
  bool scans_zip = true;  ///< false: scan%06d.pcd in the lidar's folder
  std::vector<std::string> cameras = {"camera_left_front", "camera_left_side", "camera_right_front",
                                      "camera_right_side", "camera_ir"};
  int truth_points_every = 5;  ///< scans; 0 = none
  int truth_depth_every = 10;  ///< frames; 0 = none
  /// How much earlier than its stamp a sample was measured. The real record has about 4.1 ms and 8.2 ms.
  double imu_latency_s = 0.0, gnss_latency_s = 0.0;
  Stamp start = 1568186745407734180;                    ///< of the real sample record, UTC
  Geodetic anchor{49.22810527, 16.57547959, 281.368};   ///< origin of the true map: where the IMU starts
  double street_yaw_rad = 26.5 * 0.017453292519943295;  ///< direction of the first street in map
  NoiseOptions noise;
};

/// Throws std::invalid_argument naming the field and its value.
void validate(const DriveOptions& options);

}  // namespace atlas::synthetic
