// SPDX-License-Identifier: MIT
#include "atlas/localization/attitude_model.hpp"

#include <cmath>

#include "atlas/base/geometry.hpp"

namespace atlas {

void AttitudeModel::initialize(const Eigen::Vector3d& up_imu) {
  R_map_imu_ = Eigen::Quaterniond::FromTwoVectors(up_imu, Eigen::Vector3d::UnitZ());
  turn(-yaw());
  tilt_variance_ = params_.tilt_sigma_rad * params_.tilt_sigma_rad;
  uncorrected_s_ = 0.0;
  known_ = true;
}

void AttitudeModel::integrate(const Eigen::Vector3d& first_radps, const Eigen::Vector3d& second_radps,
                              double dt_s) {
  // R(t+dt) = R(t) exp((w(t) + w(t+dt))/2 dt): second order (Sola 2017, eq. 226).
  const Eigen::Vector3d rate = 0.5 * (first_radps + second_radps) - bias_radps_;
  R_map_imu_ = (R_map_imu_ * expSo3(rate * dt_s)).normalized();
  // Angle of a gyroscope with white noise and an unknown constant bias: n^2 t + (b t)^2, here as its
  // derivative.
  const double noise = params_.gyroscope_noise_radps_sqrt_hz, bias = params_.gyroscope_bias_radps;
  const double end_s = uncorrected_s_ + dt_s;
  tilt_variance_ += noise * noise * dt_s + bias * bias * (end_s * end_s - uncorrected_s_ * uncorrected_s_);
  uncorrected_s_ = end_s;
}

void AttitudeModel::correctTilt(const Eigen::Vector3d& up_imu, const Eigen::Vector3d& up_map, double dt_s) {
  // Rotation (imu frame) that carries the model's "up" to the measured one: R exp(-e) has the measured "up".
  const Eigen::Vector3d up_model = R_map_imu_.conjugate() * up_map;
  const Eigen::Vector3d axis = up_model.cross(up_imu);
  const double angle = std::atan2(axis.norm(), up_model.dot(up_imu));
  const Eigen::Vector3d error = axis.norm() > 1e-12 ? Eigen::Vector3d(axis.normalized() * angle) : axis;
  const double keep = std::exp(-dt_s / params_.tilt_time_constant_s);  // exact for any dt: rate-invariant
  R_map_imu_ = (R_map_imu_ * expSo3(-(1.0 - keep) * error)).normalized();
  const double k_p = 1.0 / params_.tilt_time_constant_s;
  const double bias_z = bias_radps_.z();
  bias_radps_ += k_p * k_p / 16.0 * dt_s * error;
  bias_radps_.z() = bias_z;
  const double measured = params_.tilt_sigma_rad * params_.tilt_sigma_rad;
  tilt_variance_ = keep * keep * tilt_variance_ + (1.0 - keep * keep) * measured;
  uncorrected_s_ = 0.0;
}

void AttitudeModel::turn(double angle_rad) {
  R_map_imu_ = (Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()) * R_map_imu_).normalized();
}

double AttitudeModel::yaw() const { return toRollPitchYaw(R_map_imu_).yaw; }

}  // namespace atlas
