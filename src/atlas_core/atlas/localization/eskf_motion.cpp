// SPDX-License-Identifier: MIT
#include "atlas/localization/eskf_motion.hpp"

#include <cmath>

namespace atlas::eskf {
namespace {
constexpr double kEarthRate_radps = 7.292115e-5;          // WGS84
constexpr double kEarthRadius_m = 6371000.0;              // mean; the vertical's turn needs no better
constexpr double kGravityGradient_mps2_per_m = 3.086e-6;  // free-air
}  // namespace

Earth::Earth(const Geodetic& anchor)
    : rotation_radps(0.0, kEarthRate_radps * std::cos(anchor.latitude_deg * M_PI / 180.0),
                     kEarthRate_radps * std::sin(anchor.latitude_deg * M_PI / 180.0)),
      gravity_mps2(normalGravity(anchor.latitude_deg, anchor.altitude_m)),
      radius_m(kEarthRadius_m) {}

Eigen::Vector3d Earth::up(const Eigen::Vector3d& p_map) const {
  return Eigen::Vector3d(p_map.x(), p_map.y(), radius_m).normalized();
}

Eigen::Vector3d Earth::gravity(const Eigen::Vector3d& p_map) const {
  return (gravity_mps2 - kGravityGradient_mps2_per_m * p_map.z()) * up(p_map);
}

Transition move(State& state, const Earth& earth, const Inertial& first, const Inertial& second, double dt_s,
                double heading_slow_time_s) {
  const Eigen::Vector3d first_map = state.R * (first.force_mps2 - state.accel_bias);
  const Eigen::Vector3d rate = 0.5 * (first.rate_radps + second.rate_radps) - state.gyro_bias;
  const Eigen::Matrix3d R_before = state.R.toRotationMatrix();
  state.R = (expSo3(-dt_s * earth.rotation_radps) * state.R * expSo3(dt_s * rate)).normalized();
  const Eigen::Vector3d second_map = state.R * (second.force_mps2 - state.accel_bias);
  const Eigen::Vector3d others = -earth.gravity(state.p) - 2.0 * earth.rotation_radps.cross(state.v);
  // The acceleration changes linearly over the step.
  state.p += dt_s * state.v + dt_s * dt_s * ((2.0 * first_map + second_map) / 6.0 + 0.5 * others);
  state.v += dt_s * (0.5 * (first_map + second_map) + others);

  Transition transition;
  transition.dt_s = dt_s;
  transition.A = -dt_s * skew(0.5 * (first_map + second_map));
  transition.C = -dt_s * 0.5 * (R_before + state.R.toRotationMatrix());
  transition.heading_decay = std::exp(-dt_s / heading_slow_time_s);
  return transition;
}

void moveCovariance(Matrix& P, const Transition& transition, const ProcessNoise& noise) {
  // (I + D) P (I + D)' = P + E + E' + D E with E = P D', by columns: they are contiguous in memory.
  const double dt = transition.dt_s;
  const Eigen::Matrix3d At = transition.A.transpose(), Ct = transition.C.transpose();
  Eigen::Matrix<double, kSize, kMoving> E;
  E.middleCols<3>(kTheta).noalias() = P.middleCols<3>(kGyro) * Ct;
  const Eigen::Matrix<double, kSize, 3> theta = P.middleCols<3>(kTheta) + 0.5 * E.middleCols<3>(kTheta);
  E.middleCols<3>(kV).noalias() = P.middleCols<3>(kAccel) * Ct;
  E.middleCols<3>(kV).noalias() += theta * At;
  E.middleCols<3>(kP) = dt * (P.middleCols<3>(kV) + 0.5 * E.middleCols<3>(kV));
  const Eigen::Matrix<double, kMoving, kMoving> second = transition.rows<kMoving>(E);
  P.leftCols<kMoving>() += E;
  P.topLeftCorner<kMoving, kMoving>() +=
      E.topRows<kMoving>().transpose() + 0.5 * (second + second.transpose());
  P.topRightCorner<kMoving, kSize - kMoving>() = P.bottomLeftCorner<kSize - kMoving, kMoving>().transpose();
  P.row(kHeadingSlow) *= transition.heading_decay;
  P.col(kHeadingSlow) *= transition.heading_decay;

  const double accel = noise.accel_mps2_sqrt_hz * noise.accel_mps2_sqrt_hz * dt;
  const double gyro = noise.gyro_radps_sqrt_hz * noise.gyro_radps_sqrt_hz * dt;
  for (int i = 0; i < 3; ++i) {
    P(kP + i, kP + i) += accel * dt * dt / 3.0;
    P(kP + i, kV + i) += 0.5 * accel * dt;
    P(kV + i, kP + i) += 0.5 * accel * dt;
    P(kV + i, kV + i) += accel;
    P(kTheta + i, kTheta + i) += gyro;
    P(kGyro + i, kGyro + i) += noise.gyro_walk * noise.gyro_walk * dt;
    P(kAccel + i, kAccel + i) += noise.accel_walk * noise.accel_walk * dt;
  }
  P(kHeadingSlow, kHeadingSlow) += noise.heading_slow_rad * noise.heading_slow_rad *
                                   (1.0 - transition.heading_decay * transition.heading_decay);
  P(kMountYaw, kMountYaw) += noise.mount_walk * noise.mount_walk * dt;
  P(kMountPitch, kMountPitch) += noise.mount_walk * noise.mount_walk * dt;
}

}  // namespace atlas::eskf
