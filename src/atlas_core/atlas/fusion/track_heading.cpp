// SPDX-License-Identifier: MIT
// Which way a track points: the axis by boxes, forward by how it moves and by detectors that tell it.
#include <algorithm>
#include <cmath>

#include "atlas/base/geometry.hpp"
#include "atlas/fusion/track.hpp"

namespace atlas {
namespace {

constexpr double kMoves_mps = 1.0;    ///< slower ones have no course ...
constexpr double kMovesSigmas = 3.0;  ///< ... nor those whose speed is not that certain
constexpr double kMovesProbability = 0.8;
constexpr double kSlip_rad = 0.06;                          ///< between course and length axis
constexpr double kSurelyForward = 8.0;                      ///< log odds, most
constexpr double kForwardPerMps = 0.1, kMostForward = 0.5;  ///< log odds that an update adds
constexpr double kBoxForward = 0.5;                         ///< log odds of a detector's heading
constexpr int kSidewaysUpdates = 4;
constexpr double kWider = 1.15,
                 kWide_m = 2.2;  ///< what is so much wider than long was taken the wrong way round
constexpr double kSureAxis = 3.0,
                 kOtherAxis = 1.0;  ///< log odds: most, and from which its width is its length
constexpr int kContradictions = 3;  ///< measurements in its place that did not fit it
constexpr double kClassSure = 0.7;
constexpr double kYawSigmas = 3.0;

/// The same axis, within a quarter turn.
double axisDifference(double angle_rad) {
  const double d = std::remainder(angle_rad, M_PI);
  return d;
}

}  // namespace

void Track::readYaw(const YawReading& reading) {
  const double full = wrapAngle(reading.yaw_rad - yaw_rad_);
  const double d = axisDifference(full);
  double s = yaw_variance_rad2_ + reading.variance_rad2;
  const double sigmas = std::abs(d) / std::sqrt(s);
  if (sigmas > kYawSigmas) s *= sigmas / kYawSigmas;  // as the filter's rows: outliers weigh less
  const double K = yaw_variance_rad2_ / s;
  yaw_rad_ = wrapAngle(yaw_rad_ + K * d);
  yaw_variance_rad2_ *= 1.0 - K;
  if (reading.period_parts != 1) return;
  forward_log_odds_ = std::clamp(forward_log_odds_ + (std::cos(full) > 0.0 ? kBoxForward : -kBoxForward),
                                 -kSurelyForward, kSurelyForward);
}

bool Track::isContradicted(double axis_log_odds) {
  if (!physics().steers) return false;
  axis_log_odds_ = std::clamp(axis_log_odds_ + axis_log_odds, -kSureAxis, kSureAxis);
  return axis_log_odds_ < -kOtherAxis;
}

void Track::contradict(const Measurement& measurement) {
  if (++contradictions_ >= kContradictions) restartBox(measurement);
}

void Track::restartBox(const Measurement& measurement) {
  const std::optional<TrackBirth> birth = measurement.birth();
  if (!birth) return;
  filter_.restartBox(birth->shape.state);
  const double turn = std::remainder(birth->shape.yaw_rad - yaw_rad_, M_PI);
  if (std::abs(turn) > 0.25 * M_PI) forward_log_odds_ = 0.0;
  yaw_rad_ = wrapAngle(yaw_rad_ + turn);
  yaw_variance_rad2_ = birth->shape.yaw_variance_rad2;
  z_ = {birth->shape.middle_z_m.value, 0.0};
  z_covariance_ = Eigen::Vector2d(birth->shape.middle_z_m.variance, z_covariance_(1, 1)).asDiagonal();
  height_m_ = birth->shape.height_m;
  axis_log_odds_ = 0.0;
  sideways_ = contradictions_ = 0;
  std::fill(sized_.begin(), sized_.end(), 0);
  weighClasses();
  applySize();
  seen_ = stamp_;
}

void Track::followCourse() {
  const TrackState& state = filter_.estimate();
  const Eigen::Vector2d v = state.mean.segment<2>(kVx);
  const double speed = v.norm();
  const double sigma = std::sqrt(std::max(state.covariance(kVx, kVx), state.covariance(kVy, kVy)));
  const bool moves = speed > kMoves_mps && speed > kMovesSigmas * sigma &&
                     filter_.standingProbability() < 1.0 - kMovesProbability;
  if (!moves) {
    sideways_ = 0;
    return;
  }
  const double course = std::atan2(v.y(), v.x()), sigma_rad = std::hypot(sigma / speed, kSlip_rad);
  const double d = axisDifference(course - yaw_rad_);
  if (!physics().steers) {  // people turn on the spot
    yaw_rad_ = wrapAngle(yaw_rad_ + 0.5 * wrapAngle(course - yaw_rad_));
    yaw_variance_rad2_ = sigma_rad * sigma_rad;
    forward_log_odds_ = kSurelyForward;
    return;
  }
  if (std::abs(d) > 0.25 * M_PI) {
    if (++sideways_ >= kSidewaysUpdates) swapAxes();
    return;
  }
  sideways_ = 0;
  const double K = yaw_variance_rad2_ / (yaw_variance_rad2_ + sigma_rad * sigma_rad);
  yaw_rad_ = wrapAngle(yaw_rad_ + K * d);
  yaw_variance_rad2_ *= 1.0 - K;
  const double evidence = std::min(kForwardPerMps * speed, kMostForward);
  forward_log_odds_ += std::cos(course - yaw_rad_) > 0.0 ? evidence : -evidence;
  forward_log_odds_ = std::clamp(forward_log_odds_, -kSurelyForward, kSurelyForward);
  if (forward_log_odds_ < -0.5) {
    yaw_rad_ = wrapAngle(yaw_rad_ + M_PI);
    forward_log_odds_ = -forward_log_odds_;
  }
}

void Track::applySize() {
  const TrackVector mean = filter_.estimate().mean;
  const std::size_t likeliest = likeliest_;
  const bool known = likeliest < classes_->classes() && class_probability_[likeliest] > kClassSure;
  const ClassPhysics& body = physics();
  if (body.steers && mean(kWidth) > kWider * mean(kLength) && mean(kWidth) > kWide_m) swapAxes();
  if (!known || sized_[likeliest] != 0) return;
  sized_[likeliest] = 1;
  Rows rows;
  for (const int side : {kLength, kWidth}) {
    LinearRow row;
    row.h(side) = 1.0;
    row.z = body.size(side - kLength);
    row.variance = body.size_sigma(side - kLength) * body.size_sigma(side - kLength);
    rows.add(row);
  }
  Rows turned = rows;  // the back of a car, seen alone, looks like a short side
  std::swap(turned[0].h, turned[1].h);
  const TrackState& state = filter_.estimate();
  if (body.steers && sideways_ == 0 && forward_log_odds_ < kForwardPerMps &&
      distanceOf(state, turned).mahalanobis_sq + 4.0 < distanceOf(state, rows).mahalanobis_sq) {
    swapAxes();
  }
  filter_.update(rows, 0.0);
  const double variance = body.size_sigma.z() * body.size_sigma.z();
  const double K = height_m_.variance / (height_m_.variance + variance);
  height_m_.value += K * (body.size.z() - height_m_.value);
  height_m_.variance *= 1.0 - K;
}

void Track::swapAxes() {
  filter_.swapLengthAndWidth();
  yaw_rad_ = wrapAngle(yaw_rad_ + 0.5 * M_PI);
  forward_log_odds_ = 0.0;
  axis_log_odds_ = 0.0;
  sideways_ = 0;
}

}  // namespace atlas
