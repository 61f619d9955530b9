// SPDX-License-Identifier: MIT
// One tracked object: filter, heading, heights, class, existence, history.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "atlas/fusion/class_belief.hpp"
#include "atlas/fusion/measurement.hpp"
#include "atlas/sensor/object.hpp"

namespace atlas {

class Track {
 public:
  Track(std::uint32_t id, Stamp stamp, const TrackBirth& birth, std::shared_ptr<const MotionModels> models,
        std::shared_ptr<const ClassModel> classes);

  /// Moves on to `stamp`, which must not be before the last one.
  void predict(Stamp stamp);
  /// A measurement that belongs to it; the filter, the heading and the heights follow it.
  void update(const Measurement& measurement, double robust_sigmas);
  /// A measurement in its place that does not fit it. Several in a row are right: its box begins afresh.
  void contradict(const Measurement& measurement);
  /// Class and existence by it; `input` is its topic.
  void witness(const Measurement& measurement, const std::string& input);
  /// A scan that would have shown it with this probability did not.
  void miss(double detectability);

  [[nodiscard]] TrackShape shape() const;
  [[nodiscard]] std::uint32_t id() const { return id_; }
  [[nodiscard]] double existence() const { return existence_; }
  [[nodiscard]] bool confirmed() const { return confirmed_; }
  void confirmFrom(double existence) { confirmed_ = confirmed_ || existence_ >= existence; }
  void setDetectability(double p) { detectability_ = p; }
  [[nodiscard]] bool told() const { return told_; }
  [[nodiscard]] Stamp seen() const { return seen_; }
  [[nodiscard]] bool finite() const;
  /// Standard deviation of the position, the larger axis, m.
  [[nodiscard]] double positionSigma() const;
  /// Standard deviation of the velocity, the larger axis, m/s.
  [[nodiscard]] double velocitySigma() const;
  /// What is told of it; forgets the sources.
  [[nodiscard]] Object report(double static_from);
  /// Remembers the present state; at most `most` of them.
  void remember(std::size_t most);

 private:
  [[nodiscard]] bool hasMoved() const;
  [[nodiscard]] const ClassPhysics& physics() const { return classes_->physics(likeliest_); }
  void weighClasses();
  void readYaw(const YawReading& reading);
  [[nodiscard]] bool isContradicted(double axis_log_odds);
  void restartBox(const Measurement& measurement);
  void followCourse();
  void applySize();
  void swapAxes();

  std::uint32_t id_;
  Stamp born_, stamp_, seen_;
  std::shared_ptr<const ClassModel> classes_;
  TrackFilter filter_;
  double yaw_rad_, yaw_variance_rad2_;
  double forward_log_odds_;     ///< that yaw is forward and not backward
  int sideways_ = 0;            ///< updates in a row in which it moved across its length
  double axis_log_odds_ = 0.0;  ///< that its length is not its width
  int contradictions_ = 0;      ///< in a row
  Eigen::Vector2d z_;           ///< middle and its speed
  Eigen::Matrix2d z_covariance_;
  Reading height_m_;
  std::vector<double> belief_;             ///< by detections
  std::vector<double> class_probability_;  ///< by detections and size
  std::size_t likeliest_;
  std::vector<char> sized_;  ///< classes whose usual size was taken into account
  double existence_;
  bool confirmed_ = false, told_ = false;
  double detectability_ = 0.0;
  double score_sum_ = 0.0;
  int scores_ = 0;
  std::vector<Origin> sources_;
  std::deque<ObjectPast> history_;
};

}  // namespace atlas
