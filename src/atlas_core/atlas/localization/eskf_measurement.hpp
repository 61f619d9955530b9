// SPDX-License-Identifier: MIT
// What the sensors and the wheels say about the state: innovation y = z - h(x) and H = dh/d(error), for the
// error state of eskf_state.hpp. w is the rate with the bias taken out, l the lever arm, d the delay.
//
//   fix        h = p + R (l - d w x l) - d v
//   heading    h = yaw(R) + slow error;  with x = R e_x: dyaw = theta_z - x_z (x_x theta_x + x_y theta_y) /
//              (x_x^2 + x_y^2)
//   up         the direction of "up" u in the imu frame: R u - up(p) is -theta x up, two components
//   no slip    with u = R'v and w turned by -mounted about z: 0 = u_y - mount_yaw u_x - axle w_z
//              (the rear axle does not move sideways: bicycle model, Rajamani 2012, 2.2)
//   no hop     0 = u_z + mount_pitch u_x + axle w_y
//   height     h = p_z                         (of the imu, by air pressure)
//   standing   0 = v
//   not turning  gyro = b_g + R'W
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "atlas/localization/eskf_motion.hpp"
#include "atlas/localization/eskf_state.hpp"

namespace atlas::eskf {

template <int M>
struct Measurement {
  Eigen::Matrix<double, M, 1> y = Eigen::Matrix<double, M, 1>::Zero();
  Eigen::Matrix<double, M, kSize> H = Eigen::Matrix<double, M, kSize>::Zero();
  Eigen::Matrix<double, M, M> R = Eigen::Matrix<double, M, M>::Zero();
};

Measurement<3> fixMeasurement(const State& state, const Eigen::Vector3d& rate_radps,
                              const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2);
Measurement<1> headingMeasurement(const State& state, double yaw_rad, double variance);
/// up_imu: measured, unit; up_map: the vertical where the vehicle is.
Measurement<2> upMeasurement(const State& state, const Eigen::Vector3d& up_imu, const Eigen::Vector3d& up_map,
                             double variance);
/// Row 0: no slip, row 1: no hop.
Measurement<2> wheelsMeasurement(const State& state, const Eigen::Vector3d& rate_radps, double slip_variance,
                                 double hop_variance);
Measurement<1> heightMeasurement(const State& state, double z_map_m, double variance);
Measurement<3> standingMeasurement(const State& state, double variance);
/// gyro_radps: mean over a while of standing, bias included.
Measurement<3> notTurningMeasurement(const State& state, const Earth& earth,
                                     const Eigen::Vector3d& gyro_radps, double variance);

/// Innovation with its covariance S = H P H' + R and gain K = P H' S^-1.
template <int M>
struct Innovation {
  Eigen::Matrix<double, kSize, M> PHt;
  Eigen::Matrix<double, M, M> S_inverse;
  Eigen::Matrix<double, M, M> S;
  double mahalanobis_sq = 0.0;  ///< y' S^-1 y
};

template <int M>
Innovation<M> innovation(const Matrix& P, const Measurement<M>& z) {
  Innovation<M> result;
  const Eigen::Matrix<double, kSize, M> Ht = z.H.transpose();
  result.PHt.noalias() = P * Ht;
  result.S = z.H * result.PHt + z.R;
  result.S_inverse = result.S.inverse();
  result.mahalanobis_sq = z.y.dot(result.S_inverse * z.y);
  return result;
}

/// P = P - P H' S^-1 H P, symmetric by construction; returns K y.
template <int M>
Vector correct(Matrix& P, const Measurement<M>& z, const Innovation<M>& innovation) {
  const Eigen::LLT<Eigen::Matrix<double, M, M>> llt(innovation.S);
  Eigen::Matrix<double, M, kSize> W = innovation.PHt.transpose();
  llt.matrixL().solveInPlace(W);  // W' W = P H' S^-1 H P
  P.noalias() -= W.transpose() * W;
  return innovation.PHt * (innovation.S_inverse * z.y);
}

}  // namespace atlas::eskf
