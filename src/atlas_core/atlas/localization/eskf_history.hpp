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

#include "atlas/base/spilled_list.hpp"
#include "atlas/localization/eskf_measurement.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas::eskf {

class History {
 public:
  /// Where what does not fit into memory is kept; the default keeps all in memory. When the system refuses, a
  /// function that records or smooths throws std::runtime_error with folder and cause.
  explicit History(const SpillParams& spill = {}) : nodes_(spill), smoothed_(spill), samples_(spill) {}

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
    Smoothed& smoothed = smoothed_.change(smoothed_.size() - 1);
    smoothed.connected = true;
    smoothed.step = error.head<kMoving>();
  }
  /// The state at an IMU sample, after all corrections up to it.
  void sample(Stamp stamp, const State& state, const Eigen::Vector3d& rate_radps) {
    samples_.append() = {stamp, nodes_.size() - 1, state.p, state.v, state.R, rate_radps};
  }

  /// Replaces what was recorded by the smoothed run. Once.
  void smooth();

  /// Variance of the angular velocity of a sample, (rad/s)^2.
  void setRateVariance(double variance) { rate_variance_ = variance; }
  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] Stamp stamp(std::size_t i) const { return samples_[i].stamp; }
  [[nodiscard]] Odometry odometry(std::size_t i) const;
  /// True when a part of it is in the temporary file.
  [[nodiscard]] bool spilled() const { return nodes_.spilled() || smoothed_.spilled() || samples_.spilled(); }

 private:
  using MovingMatrix = Eigen::Matrix<double, kMoving, kMoving>;
  using MovingVector = Eigen::Matrix<double, kMoving, 1>;
  /// A correction, or a beginning, as the filter saw it; not needed any more after smooth().
  struct Node {
    int rows = 0;  ///< of the measurement; 0: the filter began here
    bool moved = false;
    Eigen::Matrix<double, kMoving, kSize> phi;  ///< upper rows of Phi since the node before
    double heading_decay = 1.0;
    Eigen::Matrix<double, 3, kSize> H;
    Eigen::Matrix<double, kSize, 3> PHt;
    Eigen::Matrix3d S_inverse;
    Eigen::Vector3d y;
    Eigen::Matrix<double, kMoving, kSize> P;  ///< upper rows, after the correction
  };
  /// What smooth() finds out there.
  struct Smoothed {
    Stamp stamp = 0;
    bool connected = false;   ///< false: the filter began here
    MovingVector step;        ///< K y, upper rows
    MovingVector error;       ///< smoothed minus filtered
    MovingMatrix covariance;  ///< smoothed
  };
  struct Sample {
    Stamp stamp = 0;
    std::size_t node = 0;  ///< the last one at or before it
    Eigen::Vector3d p, v;
    Eigen::Quaterniond R;
    Eigen::Vector3d rate;
  };
  Node& push(Stamp stamp, const Matrix& P);
  void correctSamples();

  SpilledList<Node> nodes_;
  SpilledList<Smoothed> smoothed_;  ///< one a node
  SpilledList<Sample> samples_;
  Matrix phi_ = Matrix::Identity();
  bool moved_ = false;
  double rate_variance_ = 0.0;
};

}  // namespace atlas::eskf
