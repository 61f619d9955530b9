// SPDX-License-Identifier: MIT
// What the error-state filter says about itself.
#include "atlas/localization/eskf_filter.hpp"

namespace atlas {

using eskf::Index;
using Matrix3 = Eigen::Matrix3d;

Eigen::Vector3d EskfFilter::rate() const { return current_->angular_velocity_radps - state_.gyro_bias; }

Odometry EskfFilter::odometry(double dt_s) const {
  Odometry odometry;
  odometry.stamp = current_->stamp;
  odometry.T_map_imu = {state_.R, state_.p};
  const Matrix3 R_imu_map = state_.R.conjugate().toRotationMatrix();
  odometry.velocity_imu_mps = R_imu_map * state_.v;
  odometry.angular_velocity_imu_radps = rate() - R_imu_map * earth_.rotation_radps;

  using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  Eigen::Map<Matrix6> pose(odometry.pose_covariance.data()), twist(odometry.twist_covariance.data());
  pose.topLeftCorner<3, 3>() = P_.block<3, 3>(Index::kP, Index::kP) + slow_fix_m2_;
  pose.topRightCorner<3, 3>() = P_.block<3, 3>(Index::kP, Index::kTheta);
  pose.bottomLeftCorner<3, 3>() = P_.block<3, 3>(Index::kTheta, Index::kP);
  pose.bottomRightCorner<3, 3>() = P_.block<3, 3>(Index::kTheta, Index::kTheta);

  // v_imu = R'v errs by R'(dv + v x theta), the rate by the gyroscope's bias and white noise.
  const Matrix3 B = R_imu_map * skew(state_.v);
  const Matrix3 cross = R_imu_map * P_.block<3, 3>(Index::kV, Index::kTheta) * B.transpose();
  twist.topLeftCorner<3, 3>() = R_imu_map * P_.block<3, 3>(Index::kV, Index::kV) * R_imu_map.transpose() +
                                B * P_.block<3, 3>(Index::kTheta, Index::kTheta) * B.transpose() + cross +
                                cross.transpose();
  const Matrix3 v_bias = -(R_imu_map * P_.block<3, 3>(Index::kV, Index::kGyro) +
                           B * P_.block<3, 3>(Index::kTheta, Index::kGyro));
  twist.topRightCorner<3, 3>() = v_bias;
  twist.bottomLeftCorner<3, 3>() = v_bias.transpose();
  const double density = params_.eskf.gyroscope_noise_radps_sqrt_hz;
  twist.bottomRightCorner<3, 3>() = P_.block<3, 3>(Index::kGyro, Index::kGyro);
  twist.diagonal().tail<3>().array() += density * density / dt_s;
  return odometry;
}

std::optional<ImuBias> EskfFilter::imuBias() const {
  if (!running_) return std::nullopt;
  return ImuBias{state_.gyro_bias, P_.diagonal().segment<3>(Index::kGyro).cwiseSqrt(), state_.accel_bias,
                 P_.diagonal().segment<3>(Index::kAccel).cwiseSqrt()};
}

}  // namespace atlas
