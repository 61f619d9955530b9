// SPDX-License-Identifier: MIT
// What the error-state Kalman filter assumes beyond what the sensors say themselves (those are in
// PositioningParams).
#pragma once

namespace atlas {

/// Noise densities and walks are those of a tactical to consumer MEMS IMU; measured vibration raises them.
struct EskfParams {
  double accelerometer_noise_mps2_sqrt_hz = 8e-4;  ///< least spectral density
  double gyroscope_noise_radps_sqrt_hz = 1.75e-4;  ///< same
  double vibration_share = 0.3;          ///< part of the white noise seen between samples that integrates
  double accelerometer_bias_mps2 = 0.2;  ///< standard deviation before any estimate
  double gyroscope_bias_radps = 0.01;    ///< same; a vehicle that stood has measured it
  double accelerometer_bias_walk_mps3_sqrt_hz = 3e-5;  ///< random walk
  double gyroscope_bias_walk_radps2_sqrt_hz = 7e-6;    ///< random walk
  double mount_sigma_rad = 0.1;                        ///< angle between imu x and the direction of driving
  double lever_arm_sigma_m = 0.0;                      ///< 0: the lever arm is right
  double gnss_delay_sigma_s = 0.0;                     ///< 0: the fixes' stamps are right
  double slip_sigma_mps = 0.03;       ///< sideways and vertical velocity of the rear axle while driving ...
  double slip_sigma_rad = 0.005;      ///< ... and its part that grows with speed
  double axle_height_m = 1.5;         ///< imu above the axle: what roll and pitch rates do to its velocity
  double standing_sigma_mps = 0.015;  ///< velocity while standing
  double recovery_s = 5.0;            ///< fixes rejected for so long are right, and the filter is not
};

}  // namespace atlas
