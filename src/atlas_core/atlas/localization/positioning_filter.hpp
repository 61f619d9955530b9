// SPDX-License-Identifier: MIT
// One interface for all positioning filters. Adding one touches its own file and one line of
// makePositioningFilter().
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "atlas/base/counters.hpp"
#include "atlas/base/geodesy.hpp"
#include "atlas/localization/eskf_params.hpp"
#include "atlas/sensor/products.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct PositioningParams {
  double gnss_horizontal_sigma_m = 0.02;   ///< used for fixes without covariance
  double gnss_vertical_sigma_m = 0.04;     ///< same
  double gnss_heading_sigma_rad = 0.0524;  ///< 3 deg; used for headings without variance
  double gnss_heading_slow_share =
      0.8;  ///< part of the heading variance that wanders slowly instead of being white
  double gnss_heading_slow_time_s = 20.0;            ///< correlation time of that part
  double accelerometer_noise_mps2_sqrt_hz = 0.05;    ///< spectral density; covers vibration and timing
  double accelerometer_bias_mps2 = 0.03;             ///< standard deviation of the slow error of one axis
  double accelerometer_bias_time_s = 60.0;           ///< its correlation time
  double gyroscope_noise_radps_sqrt_hz = 0.0005;     ///< spectral density
  double gyroscope_bias_radps = 0.0035;              ///< 0.2 deg/s; standard deviation before any estimate
  double gyroscope_bias_walk_radps2_sqrt_hz = 1e-5;  ///< random walk of the bias
  double tilt_sigma_rad = 0.0044;     ///< 0.25 deg; standard deviation of the IMU's own roll and pitch
  double tilt_time_constant_s = 2.5;  ///< low-pass of roll and pitch towards the IMU's own (paper IV-A)
  double velocity_heading_min_speed_mps =
      2.0;                                  ///< below it the velocity's direction says nothing about heading
  double velocity_heading_slip_rad = 0.01;  ///< standard deviation of the rear axle's slip angle
  double imu_to_rear_axle_m = 1.3;        ///< the IMU is this far ahead of the axle that cannot move sideways
  double imu_to_rear_axle_sigma_m = 0.7;  ///< how well that is known; the filter estimates the rest in turns
  double gate_mahalanobis_sq = 30.0;      ///< a fix beyond it is an outlier; chi-square, 3 dof: p = 1.4e-6
  double heading_gate_mahalanobis_sq = 16.0;  ///< same for headings; 1 dof: p = 6e-5
  double max_consecutive_rejections =
      5;                       ///< after so many outliers in a row the fixes are right and the filter is not
  double max_imu_gap_s = 0.5;  ///< a longer gap restarts the filter
  EskfParams eskf;             ///< what only the filter "eskf" uses
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const PositioningParams& params);

/// What a measurement said against the prediction.
struct InnovationRecord {
  Stamp stamp = 0;
  const char* source = "";  ///< "fix", "heading", "wheels", "standing", "not turning", "up", "pressure"
  int rows = 0;             ///< components in use
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();  ///< m, rad, m/s or rad/s
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();       ///< square roots of the diagonal of S
  double mahalanobis_sq = 0.0;
  bool used = false;  ///< false: gated out
};

/// Estimated errors of the IMU with their standard deviations, imu frame.
struct ImuBias {
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero(), gyro_sigma_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero(), accel_sigma_mps2 = Eigen::Vector3d::Zero();
};

namespace eskf {
class History;
}

/// Events come in stamp order. The filter works in `map` = ENU at the anchor.
class PositioningFilter {
 public:
  virtual ~PositioningFilter() = default;
  /// p_map_antenna: GNSS antenna in map, m. R: covariance ENU, m^2. Takes effect with the next IMU sample, at
  /// its own stamp.
  virtual void update(Stamp stamp, const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2) = 0;
  /// yaw of the imu x axis in map. Takes effect with the next IMU sample, at its own stamp.
  virtual void updateHeading(Stamp stamp, double yaw_rad, double variance_rad2) = 0;
  /// Height of the imu in map by air pressure; a filter that does not use it ignores it.
  virtual void updateHeight(Stamp /*stamp*/, double /*z_map_m*/, double /*variance_m2*/) {}
  /// Propagates to the sample's stamp; the odometry at that stamp, or nullopt while position, velocity,
  /// attitude or heading is unknown.
  virtual std::optional<Odometry> propagate(const ImuSample& sample) = 0;
  /// The motion up to the present sample is in doubt: variances per axis of velocity, (m/s)^2, and turn,
  /// rad^2.
  virtual void distrust(double /*velocity_variance*/, double /*turn_variance*/) {}
  /// No more samples: counts the fixes and headings that no sample followed.
  virtual void finish() = 0;

  /// None when the filter does not estimate them, or not yet.
  [[nodiscard]] virtual std::optional<ImuBias> imuBias() const { return std::nullopt; }
  /// Records the run for smoothing; false when the filter has no smoother. The history must outlive the
  /// filter.
  virtual bool record(eskf::History* /*history*/) { return false; }

  std::function<void(const InnovationRecord&)> on_innovation;  ///< one per measurement, used or not
};

/// lever_arm_imu: antenna in the imu frame, m. What the filter uses, rejects and skips goes to `counters`,
/// which must outlive it. Throws std::invalid_argument for an unknown name.
std::unique_ptr<PositioningFilter> makePositioningFilter(const std::string& name,
                                                         const PositioningParams& params,
                                                         const Eigen::Vector3d& lever_arm_imu,
                                                         const Geodetic& anchor, Counters& counters);

}  // namespace atlas
