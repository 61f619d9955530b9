// SPDX-License-Identifier: MIT
// State of one tracked object and its interacting multiple models: the object stands, drives straight or
// turns, each with a probability (Blom and Bar-Shalom 1988, "The interacting multiple model algorithm for
// systems with Markovian switching coefficients"). Static or dynamic is a probability, not a threshold on a
// noisy speed.
//
// x = (position, velocity, turn rate, length, width) in map. Length and width belong to the state because a
// lidar sees the near sides only: a side is a row  z = u . position +- length/2, so that what becomes visible
// later moves the far side and not the object.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace atlas {

enum TrackIndex : int { kPx, kPy, kVx, kVy, kTurnRate, kLength, kWidth, kTrackStates };
using TrackVector = Eigen::Matrix<double, kTrackStates, 1>;
using TrackMatrix = Eigen::Matrix<double, kTrackStates, kTrackStates>;
struct TrackState {
  TrackVector mean = TrackVector::Zero();
  TrackMatrix covariance = TrackMatrix::Identity();
};

/// One independent measurement: z = h . x + noise.
struct LinearRow {
  TrackVector h = TrackVector::Zero();
  double z = 0.0, variance = 1.0;
};
class Rows {
 public:
  void add(const LinearRow& row);
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] const LinearRow& operator[](std::size_t i) const { return rows_[i]; }
  [[nodiscard]] LinearRow& operator[](std::size_t i) { return rows_[i]; }

 private:
  static constexpr std::size_t kMost = 6;
  std::array<LinearRow, kMost> rows_;
  std::size_t count_ = 0;
};
/// Squared Mahalanobis distance of all rows and the log of the determinant of their innovation covariance.
struct RowDistance {
  double mahalanobis_sq = 0.0, log_determinant = 0.0;
};
[[nodiscard]] RowDistance distanceOf(const TrackState& state, const Rows& rows);

/// How lively objects of a class move.
struct MotionNoise {
  double acceleration_mps2_sqrt_s = 1.5;         ///< density of the white acceleration
  double turn_acceleration_radps2_sqrt_s = 0.5;  ///< same, of the turn rate
};

/// A way to move: a plug point. Add a function that makes one and its line in motionModels().
struct MotionModel {
  std::string name;
  bool stands = false;  ///< its probability is that of being static
  std::function<void(TrackState&, double dt_s, const MotionNoise&)> predict;
};
using MotionModels = std::vector<MotionModel>;
[[nodiscard]] MotionModel standing();
[[nodiscard]] MotionModel constantVelocity();
[[nodiscard]] MotionModel constantTurn();
/// All models, in the order in which weights are given.
[[nodiscard]] MotionModels motionModels();

/// Which models objects of a class use.
struct MotionProfile {
  std::vector<double> weights = {0.6, 0.3, 0.1};  ///< of each model in the long run; 0 = not used
  double switches_per_s = 0.12;                   ///< how often the way to move changes
  MotionNoise noise;
};
/// Throws std::invalid_argument naming the field and its value.
void validate(const MotionProfile& profile, std::size_t models);

class TrackFilter {
 public:
  /// A model that stands begins at rest, the others with the velocity of `born`.
  TrackFilter(std::shared_ptr<const MotionModels> models, const TrackState& born,
              const MotionProfile& profile);

  void predict(double dt_s, const MotionProfile& profile);
  /// Rows farther off than `robust_sigmas` (of the mixture) weigh less, as Huber's; 0 = all weigh the same.
  void update(const Rows& rows, double robust_sigmas);
  /// Mixture of all models.
  [[nodiscard]] const TrackState& estimate() const { return estimate_; }
  [[nodiscard]] const std::vector<double>& probabilities() const { return probability_; }
  /// That it stands, or moves slower than 0.5 m/s.
  [[nodiscard]] double standingProbability() const;
  /// Place and size are those of `born`, whatever they were; how it moves stays.
  void restartBox(const TrackState& born);
  /// Length and width change places: what was taken for the front is a side.
  void swapLengthAndWidth();

 private:
  void mix(double dt_s, const MotionProfile& profile);
  void combine();

  std::shared_ptr<const MotionModels> models_;
  std::vector<TrackState> states_;  ///< by model
  std::vector<double> probability_;
  TrackState estimate_;
};

}  // namespace atlas
