// SPDX-License-Identifier: MIT
#include "atlas/localization/eskf_history.hpp"

namespace atlas::eskf {

History::Node& History::push(Stamp stamp, const Matrix& P) {
  smoothed_.append().stamp = stamp;
  Node& node = nodes_.append();
  node.P = P.topRows<kMoving>();
  node.moved = moved_;
  if (moved_) {
    node.phi = phi_.topRows<kMoving>();
    node.heading_decay = phi_(kHeadingSlow, kHeadingSlow);
    phi_.setIdentity();
    moved_ = false;
  }
  return node;
}

void History::begin(Stamp stamp, const Matrix& P) {
  phi_.setIdentity();
  moved_ = false;
  Node& node = push(stamp, P);
  node.rows = 0;
  smoothed_.change(smoothed_.size() - 1).step.setZero();
}

void History::smooth() {
  Vector lambda = Vector::Zero();
  Matrix Lambda = Matrix::Zero();
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& node = nodes_[i];
    Smoothed& smoothed = smoothed_.change(i);
    smoothed.error = -node.P * lambda;
    const Eigen::Matrix<double, kMoving, kSize> PL = node.P * Lambda;
    smoothed.covariance = node.P.leftCols<kMoving>() - PL * node.P.transpose();
    if (node.rows == 0) {  // nothing of what follows tells about what was before
      lambda.setZero();
      Lambda.setZero();
      continue;
    }
    const int m = node.rows;
    const Eigen::MatrixXd H = node.H.topRows(m),
                          K = node.PHt.leftCols(m) * node.S_inverse.topLeftCorner(m, m);
    const Eigen::MatrixXd S_inverse = node.S_inverse.topLeftCorner(m, m);
    lambda -= H.transpose() * (K.transpose() * lambda + S_inverse * node.y.head(m));
    const Eigen::MatrixXd LK = Lambda * K;
    Lambda += H.transpose() * (K.transpose() * LK + S_inverse) * H - H.transpose() * LK.transpose() - LK * H;
    if (node.moved) {
      Matrix phi = Matrix::Identity();
      phi.topRows<kMoving>() = node.phi;
      phi(kHeadingSlow, kHeadingSlow) = node.heading_decay;
      lambda = phi.transpose() * lambda;
      Lambda = phi.transpose() * Lambda * phi;
    }
    Lambda = 0.5 * (Lambda + Lambda.transpose()).eval();
  }
  nodes_.clear();
  correctSamples();
}

void History::correctSamples() {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    Sample& sample = samples_.change(i);
    const Smoothed& before = smoothed_[sample.node];
    MovingVector error = before.error;
    if (sample.node + 1 < smoothed_.size() && smoothed_[sample.node + 1].connected) {
      const Smoothed& after = smoothed_[sample.node + 1];
      const MovingVector end = after.error + after.step;  // relative to the prediction that `after` corrected
      const double span = static_cast<double>(after.stamp - before.stamp);
      const double ratio = span > 0.0 ? static_cast<double>(sample.stamp - before.stamp) / span : 1.0;
      error += ratio * (end - before.error);
    }
    sample.p += error.segment<3>(kP);
    sample.v += error.segment<3>(kV);
    sample.R = (expSo3(error.segment<3>(kTheta)) * sample.R).normalized();
  }
}

Odometry History::odometry(std::size_t i) const {
  const Sample& sample = samples_[i];
  Odometry odometry;
  odometry.stamp = sample.stamp;
  odometry.T_map_imu = {sample.R, sample.p};
  odometry.velocity_imu_mps = sample.R.conjugate() * sample.v;
  odometry.angular_velocity_imu_radps = sample.rate;
  const MovingMatrix& P = smoothed_[sample.node].covariance;
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> pose(odometry.pose_covariance.data());
  pose << P.block<3, 3>(kP, kP), P.block<3, 3>(kP, kTheta), P.block<3, 3>(kTheta, kP),
      P.block<3, 3>(kTheta, kTheta);
  Eigen::Matrix<double, 3, kMoving> J = Eigen::Matrix<double, 3, kMoving>::Zero();  // of R'v
  J.middleCols<3>(kV) = sample.R.conjugate().toRotationMatrix();
  J.middleCols<3>(kTheta) = J.middleCols<3>(kV) * skew(sample.v);
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> twist(odometry.twist_covariance.data());
  twist.topLeftCorner<3, 3>() = J * P * J.transpose();
  twist.bottomRightCorner<3, 3>() = rate_variance_ * Eigen::Matrix3d::Identity();
  return odometry;
}

}  // namespace atlas::eskf
