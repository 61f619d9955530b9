// SPDX-License-Identifier: MIT
// How the state and its covariance move with the IMU (Groves 2013, 5.4 and 14.2.4, in a local tangent frame;
// Sola 2017, eq. 238 and 268-270 for the global error).
//
//   rate        w = gyro - b_g                     the Earth's rotation W (map) is taken out of the attitude
//   force       f = accel - b_a
//   attitude    R(t+dt) = exp(-[W dt]x) R(t) exp([w dt]x)
//   velocity    v' = R f - g(p) - 2 W x v          normal gravity along the vertical at p, Coriolis
//   position    p' = v
//   errors      theta' = -R db_g + n_g,  dv' = -[R f]x theta - R db_a + n_a,  dp' = dv
//               biases: random walks; slow heading error: first-order Gauss-Markov
//   step        Phi = I + D, D with rows for p, v, theta only:
//               D_theta = C db_g,  D_v = A (theta + D_theta / 2) + C db_a,  D_p = dt (dv + D_v / 2)
//               with C = -R dt, A = -[R f]x dt
#pragma once

#include "atlas/base/geodesy.hpp"
#include "atlas/localization/eskf_state.hpp"

namespace atlas::eskf {

/// The Earth at the anchor, map axes.
struct Earth {
  explicit Earth(const Geodetic& anchor);
  Eigen::Vector3d rotation_radps;  ///< W
  double gravity_mps2;             ///< at the anchor
  double radius_m;                 ///< the vertical turns by distance / radius
  /// Unit vector, up, at a point of map.
  [[nodiscard]] Eigen::Vector3d up(const Eigen::Vector3d& p_map) const;
  /// Downwards acceleration of free fall at a point of map (gravity falls by 3.086e-6 1/s^2 a metre).
  [[nodiscard]] Eigen::Vector3d gravity(const Eigen::Vector3d& p_map) const;
};

/// Inertial measurement at one time, biases included.
struct Inertial {
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();
};

/// Spectral densities of what drives the errors.
struct ProcessNoise {
  double gyro_radps_sqrt_hz = 0.0;
  double accel_mps2_sqrt_hz = 0.0;
  double gyro_walk = 0.0;   ///< rad/s / sqrt(s)
  double accel_walk = 0.0;  ///< m/s^2 / sqrt(s)
  double heading_slow_rad = 0.0, heading_slow_time_s = 1.0;
  double mount_walk = 0.0;  ///< 1/sqrt(s)
};

/// D of Phi = I + D, and the decay of the slow heading error.
struct Transition {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero(), C = Eigen::Matrix3d::Zero();
  double dt_s = 0.0;
  double heading_decay = 1.0;

  /// D M for the rows of p, v, theta.
  template <int Columns>
  [[nodiscard]] Eigen::Matrix<double, kMoving, Columns> rows(
      const Eigen::Matrix<double, kSize, Columns>& M) const {
    Eigen::Matrix<double, kMoving, Columns> D;
    D.template middleRows<3>(kTheta).noalias() = C * M.template middleRows<3>(kGyro);
    const Eigen::Matrix<double, 3, Columns> theta =
        M.template middleRows<3>(kTheta) + 0.5 * D.template middleRows<3>(kTheta);
    D.template middleRows<3>(kV).noalias() = C * M.template middleRows<3>(kAccel);
    D.template middleRows<3>(kV).noalias() += A * theta;
    D.template middleRows<3>(kP) = dt_s * (M.template middleRows<3>(kV) + 0.5 * D.template middleRows<3>(kV));
    return D;
  }
  /// Phi M.
  template <int Columns>
  void apply(Eigen::Matrix<double, kSize, Columns>& M) const {
    const Eigen::Matrix<double, kMoving, Columns> D = rows<Columns>(M);
    M.template topRows<kMoving>() += D;
    M.row(kHeadingSlow) *= heading_decay;
  }
};

/// Moves the nominal state by dt between two measurements; returns the transition of its errors.
Transition move(State& state, const Earth& earth, const Inertial& first, const Inertial& second, double dt_s,
                double heading_slow_time_s);
/// P = Phi P Phi' + Q.
void moveCovariance(Matrix& P, const Transition& transition, const ProcessNoise& noise);

}  // namespace atlas::eskf
