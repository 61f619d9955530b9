// SPDX-License-Identifier: MIT
#include "atlas/fusion/track.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/base/geometry.hpp"

namespace atlas {
namespace {

constexpr double kLasting_s = 60.0,
                 kUnseenLasting_s = 3.0;  ///< an object leaves, or was none, after so long
constexpr double kBodies = 1.5;           ///< bodies differ so much more than their usual spread
constexpr double kLeastFit = 1e-5;        ///< of a body to a class
constexpr double kUnseen_s = 0.35;        ///< without a measurement
constexpr double kMostCertain = 0.999;
constexpr double kClimb_mps2_sqrt_s = 0.3, kClimb_mps = 0.3;  ///< slopes of roads
constexpr double kHeightWalk_m_sqrt_s = 0.05;
constexpr double kWayLeast_s = 0.4, kWay_s = 1.0;               ///< over which a speed shows as a way ...
constexpr double kWayShare = 0.6;                               ///< ... of so much of what the speed says
constexpr double kSurelyForward = 8.0, kWholeBoxForward = 3.0;  ///< log odds

}  // namespace

Track::Track(std::uint32_t id, Stamp stamp, const TrackBirth& birth,
             std::shared_ptr<const MotionModels> models, std::shared_ptr<const ClassModel> classes)
    : id_(id),
      born_(stamp),
      stamp_(stamp),
      seen_(stamp),
      classes_(std::move(classes)),
      filter_(std::move(models), birth.shape.state, classes_->physics(classes_->classes()).motion),
      yaw_rad_(wrapAngle(birth.shape.yaw_rad)),
      yaw_variance_rad2_(birth.shape.yaw_variance_rad2),
      forward_log_odds_(birth.heading_known ? kWholeBoxForward : 0.0),
      z_(birth.shape.middle_z_m.value, 0.0),
      z_covariance_(Eigen::Vector2d(birth.shape.middle_z_m.variance, kClimb_mps * kClimb_mps).asDiagonal()),
      height_m_(birth.shape.height_m),
      belief_(classes_->prior()),
      class_probability_(belief_),
      likeliest_(classes_->classes()),
      sized_(classes_->classes(), 0),
      existence_(birth.existence) {}

void Track::weighClasses() {
  class_probability_ = belief_;
  const TrackState& state = filter_.estimate();
  double sum = belief_.back();
  for (std::size_t i = 0; i < classes_->classes(); ++i) {
    const ClassPhysics& body = classes_->physics(i);
    double odd_sq = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double variance = k < 2 ? state.covariance(kLength + k, kLength + k) : height_m_.variance;
      const double known = k < 2 ? state.mean(kLength + k) : height_m_.value;
      const double sigma = std::sqrt(variance + kBodies * kBodies * body.size_sigma(k) * body.size_sigma(k));
      const double odd = std::max(0.0, std::abs(known - body.size(k)) / sigma - 1.0);
      odd_sq += odd * odd;
    }
    class_probability_[i] *= std::max(std::exp(-0.5 * odd_sq), kLeastFit);
    sum += class_probability_[i];
  }
  for (double& p : class_probability_) p /= sum;
  likeliest_ = ClassModel::likeliest(class_probability_);
}

void Track::predict(Stamp stamp) {
  const double dt_s = toSeconds(stamp - stamp_);
  if (dt_s <= 0.0) return;
  stamp_ = stamp;
  filter_.predict(dt_s, physics().motion);
  const double turn = filter_.estimate().mean(kTurnRate) * (1.0 - filter_.standingProbability());
  yaw_rad_ = wrapAngle(yaw_rad_ + turn * dt_s);
  const double turn_sigma = 0.02 + 0.3 * (1.0 - filter_.standingProbability());
  yaw_variance_rad2_ = std::min(yaw_variance_rad2_ + turn_sigma * turn_sigma * dt_s, 3.0);
  Eigen::Matrix2d F;
  F << 1.0, dt_s, 0.0, std::exp(-dt_s);
  z_ = F * z_;
  z_covariance_ = F * z_covariance_ * F.transpose();
  z_covariance_(1, 1) += kClimb_mps2_sqrt_s * kClimb_mps2_sqrt_s * dt_s;
  height_m_.variance += kHeightWalk_m_sqrt_s * kHeightWalk_m_sqrt_s * dt_s;
  const bool unseen = toSeconds(stamp_ - seen_) > kUnseen_s;
  existence_ *= std::exp(-dt_s / (unseen ? kUnseenLasting_s : kLasting_s));
}

TrackShape Track::shape() const {
  TrackShape shape;
  shape.state = filter_.estimate();
  shape.yaw_rad = yaw_rad_;
  shape.yaw_variance_rad2 = yaw_variance_rad2_;
  shape.steers = physics().steers;
  shape.middle_z_m = {z_.x(), z_covariance_(0, 0)};
  shape.height_m = height_m_;
  return shape;
}

void Track::update(const Measurement& measurement, double robust_sigmas) {
  contradictions_ = 0;
  const Measured measured = measurement.measured(shape());
  if (isContradicted(measured.axis_log_odds)) return restartBox(measurement);
  filter_.update(measured.rows, robust_sigmas);
  if (measured.yaw) readYaw(*measured.yaw);
  if (measured.middle_z_m) {
    const double s = z_covariance_(0, 0) + measured.middle_z_m->variance;
    const Eigen::Vector2d K = z_covariance_.col(0) / s;
    z_ += K * (measured.middle_z_m->value - z_.x());
    z_covariance_ -= K * K.transpose() * s;
  }
  if (measured.height_m) {
    const double K = height_m_.variance / (height_m_.variance + measured.height_m->variance);
    height_m_.value += K * (measured.height_m->value - height_m_.value);
    height_m_.variance *= 1.0 - K;
  }
  followCourse();
  weighClasses();
  applySize();
  seen_ = stamp_;
}

void Track::witness(const Measurement& measurement, const std::string& input) {
  if (measurement.coco_class >= 0) classes_->update(belief_, measurement.coco_class, measurement.confidence);
  const double odds = existence_ / (1.0 - std::min(existence_, kMostCertain)) * measurement.existence_ratio;
  existence_ = std::min(odds / (1.0 + odds), kMostCertain);
  if (measurement.score) {
    score_sum_ += *measurement.score;
    ++scores_;
  }
  sources_.push_back({input, stamp_, {}, measurement.index});
  weighClasses();
}

void Track::miss(double detectability) {
  existence_ *= (1.0 - detectability) / (1.0 - existence_ * detectability);
}

bool Track::finite() const {
  return filter_.estimate().mean.allFinite() && filter_.estimate().covariance.allFinite() &&
         std::isfinite(yaw_rad_);
}

double Track::positionSigma() const {
  const auto& P = filter_.estimate().covariance;
  return std::sqrt(std::max(P(kPx, kPx), P(kPy, kPy)));
}

double Track::velocitySigma() const {
  const auto& P = filter_.estimate().covariance;
  return std::sqrt(std::max(P(kVx, kVx), P(kVy, kVy)));
}

/// Its speed is confirmed by the way that it has come: what becomes visible of a body moves it once.
bool Track::hasMoved() const {
  const ObjectPast* past = nullptr;
  for (const ObjectPast& then : history_) {
    if (toSeconds(stamp_ - then.stamp) < kWayLeast_s) break;
    past = &then;
    if (toSeconds(stamp_ - then.stamp) <= kWay_s) break;
  }
  if (past == nullptr) return false;
  const Eigen::Vector2d v = filter_.estimate().mean.segment<2>(kVx);
  const Eigen::Vector2d way = filter_.estimate().mean.head<2>() - past->position.head<2>();
  return way.dot(v) >= kWayShare * v.squaredNorm() * toSeconds(stamp_ - past->stamp);
}

Object Track::report(double static_from) {
  const TrackState& state = filter_.estimate();
  Object object;
  object.id = id_;
  object.class_id = likeliest_ < classes_->classes() ? classes_->coco(likeliest_) : -1;
  object.class_probability = class_probability_[likeliest_];
  object.class_probabilities = class_probability_;
  object.existence = existence_;
  object.position = {state.mean(kPx), state.mean(kPy), z_.x()};
  object.yaw_rad = yaw_rad_;
  object.heading_known = forward_log_odds_ > 1.0;
  object.size = {state.mean(kLength), state.mean(kWidth), height_m_.value};
  object.velocity_mps = {state.mean(kVx), state.mean(kVy), z_.y()};
  object.yaw_rate_radps = state.mean(kTurnRate);
  for (int i = 0; i < 25; ++i)
    object.covariance[static_cast<std::size_t>(i)] = state.covariance(i / 5, i % 5);
  object.z_variance_m2 = z_covariance_(0, 0);
  object.yaw_variance_rad2 = yaw_variance_rad2_;
  object.static_probability = filter_.standingProbability();
  object.is_static = object.static_probability >= static_from || !hasMoved();
  object.age_s = toSeconds(stamp_ - born_);
  object.unseen_s = toSeconds(stamp_ - seen_);
  object.detectability = detectability_;
  object.score = scores_ > 0 ? score_sum_ / scores_ : 0.0;
  told_ = true;
  object.sources.swap(sources_);
  object.history.assign(history_.begin(), history_.end());
  return object;
}

void Track::remember(std::size_t most) {
  const TrackVector& mean = filter_.estimate().mean;
  history_.push_back({stamp_, {mean(kPx), mean(kPy), z_.x()}, {mean(kVx), mean(kVy), z_.y()}, yaw_rad_});
  while (history_.size() > most) history_.pop_front();
}

}  // namespace atlas
