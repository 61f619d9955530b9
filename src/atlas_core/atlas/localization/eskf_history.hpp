// SPDX-License-Identifier: MIT
// Recording of a filter run and its fixed-interval smoothing: each state gets the measurements after it, too.
// The modified Bryson-Frazier form of the Rauch-Tung-Striebel smoother (Bierman 1973, "Fixed interval
// smoothing with discrete measurements", Int. J. Control 18; Rauch, Tung, Striebel 1965): the same estimates
// without the inverse of a predicted covariance, so that states known for certain do no harm, and without the
// process noise, so that the filter may add any (gaps, recoveries).
//
//   after the last      lambda = 0, Lambda = 0
//   at a correction     lambda = (I - K H)' lambda - H' S^-1 y
//                       Lambda = (I - K H)' Lambda (I - K H) + H' S^-1 H
//   between two         lambda = Phi' lambda,  Lambda = Phi' Lambda Phi
//   smoothed            error = -P lambda,  covariance = P - P Lambda P      (P: of the filter, at that time)
//
// Between two corrections the error is interpolated linearly: they are fractions of a second apart.
#pragma once

#include <deque>

#include "atlas/localization/eskf_measurement.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas::eskf {

class History {
 public:
  /// The filter begins (anew): nothing before is connected with what follows.
  void begin(Stamp stamp, const Matrix& P);
  void moved(const Transition& transition) {
    transition.apply<kSize>(phi_);
    moved_ = true;
  }
  template <int M>
  void corrected(Stamp stamp, const Measurement<M>& z, const Innovation<M>& innovation, const Vector& error,
                 const Matrix& P) {
    Node& node = push(stamp, P);
    node.rows = M;
    node.H.topRows<M>() = z.H;
    node.PHt.leftCols<M>() = innovation.PHt;
    node.S_inverse.topLeftCorner<M, M>() = innovation.S_inverse;
    node.y.head<M>() = z.y;
    node.step = error.head<kMoving>();
  }
  /// The state at an IMU sample, after all corrections up to it.
  void sample(Stamp stamp, const State& state, const Eigen::Vector3d& rate_radps) {
    samples_.push_back({stamp, nodes_.size() - 1, state.p, state.v, state.R, rate_radps});
  }

  /// Replaces what was recorded by the smoothed run. Once.
  void smooth();

  /// Variance of the angular velocity of a sample, (rad/s)^2.
  void setRateVariance(double variance) { rate_variance_ = variance; }
  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] Stamp stamp(std::size_t i) const { return samples_[i].stamp; }
  [[nodiscard]] Odometry odometry(std::size_t i) const;

 private:
  using MovingMatrix = Eigen::Matrix<double, kMoving, kMoving>;
  using MovingVector = Eigen::Matrix<double, kMoving, 1>;
  struct Node {
    Stamp stamp = 0;
    int rows = 0;  ///< of the measurement; 0: the filter began here
    bool moved = false;
    Eigen::Matrix<double, kMoving, kSize> phi;  ///< upper rows of Phi since the node before
    double heading_decay = 1.0;
    Eigen::Matrix<double, 3, kSize> H;
    Eigen::Matrix<double, kSize, 3> PHt;
    Eigen::Matrix3d S_inverse;
    Eigen::Vector3d y;
    MovingVector step;                        ///< K y, upper rows
    Eigen::Matrix<double, kMoving, kSize> P;  ///< upper rows, after the correction
    MovingVector error;                       ///< smoothed minus filtered, after smooth()
    MovingMatrix covariance;                  ///< smoothed, after smooth()
  };
  struct Sample {
    Stamp stamp;
    std::size_t node;  ///< the last one at or before it
    Eigen::Vector3d p, v;
    Eigen::Quaterniond R;
    Eigen::Vector3d rate;
  };
  Node& push(Stamp stamp, const Matrix& P);
  void correctSamples();

  std::deque<Node> nodes_;
  std::deque<Sample> samples_;
  Matrix phi_ = Matrix::Identity();
  bool moved_ = false;
  double rate_variance_ = 0.0;
};

}  // namespace atlas::eskf
