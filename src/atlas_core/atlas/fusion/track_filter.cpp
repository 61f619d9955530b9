// SPDX-License-Identifier: MIT
#include "atlas/fusion/track_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "atlas/base/check.hpp"

namespace atlas {
namespace {

constexpr double kLeastProbability = 1e-6;  ///< a model that is ruled out can come back
constexpr double kStands_mps = 0.5;         ///< what is slower stands: the seen part of a body moves as much
constexpr double kSmallest_m = 0.02;        ///< of a length or width

double normal(std::vector<double>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return sum;
}

}  // namespace

void Rows::add(const LinearRow& row) {
  ATLAS_CHECK(count_ < kMost, "more rows than a measurement can have");
  rows_[count_++] = row;
}

RowDistance distanceOf(const TrackState& state, const Rows& rows) {
  TrackState trial = state;
  RowDistance distance;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const LinearRow& row = rows[i];
    const TrackVector Ph = trial.covariance * row.h;
    const double s = row.h.dot(Ph) + row.variance, residual = row.z - row.h.dot(trial.mean);
    distance.mahalanobis_sq += residual * residual / s;
    distance.log_determinant += std::log(s);
    if (i + 1 == rows.size()) break;
    trial.mean += Ph * (residual / s);
    trial.covariance -= Ph * Ph.transpose() / s;
  }
  return distance;
}

void validate(const MotionProfile& profile, std::size_t models) {
  double sum = 0.0;
  for (const double weight : profile.weights) {
    if (!(weight >= 0.0))
      throw std::invalid_argument("motion weights must not be negative, got " + std::to_string(weight));
    sum += weight;
  }
  if (profile.weights.size() != models || !(sum > 0.0))
    throw std::invalid_argument("motion weights must be " + std::to_string(models) +
                                " with a positive sum, got " + std::to_string(profile.weights.size()) +
                                " with sum " + std::to_string(sum));
  if (!(profile.switches_per_s >= 0.0))
    throw std::invalid_argument("switches_per_s must not be negative, got " +
                                std::to_string(profile.switches_per_s));
}

TrackFilter::TrackFilter(std::shared_ptr<const MotionModels> models, const TrackState& born,
                         const MotionProfile& profile)
    : models_(std::move(models)), states_(models_->size(), born), probability_(profile.weights) {
  normal(probability_);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if ((*models_)[i].stands) (*models_)[i].predict(states_[i], 0.0, profile.noise);
  }
  combine();
}

void TrackFilter::predict(double dt_s, const MotionProfile& profile) {
  mix(dt_s, profile);
  for (std::size_t i = 0; i < states_.size(); ++i) (*models_)[i].predict(states_[i], dt_s, profile.noise);
  combine();
}

void TrackFilter::mix(double dt_s, const MotionProfile& profile) {
  const std::size_t n = states_.size();
  const double sum = std::accumulate(profile.weights.begin(), profile.weights.end(), 0.0);
  const double leave = 1.0 - std::exp(-profile.switches_per_s * dt_s);
  std::vector<double> next(n, 0.0);
  std::vector<TrackState> mixed(n);
  for (std::size_t j = 0; j < n; ++j) {
    const double into = leave * profile.weights[j] / sum;  // from any model; staying adds 1 - leave
    std::vector<double> from(n);
    for (std::size_t i = 0; i < n; ++i) from[i] = probability_[i] * (into + (i == j ? 1.0 - leave : 0.0));
    for (double& share : from) share = std::max(share, 1e-30);
    next[j] = normal(from);
    mixed[j].mean.setZero();
    mixed[j].covariance.setZero();
    for (std::size_t i = 0; i < n; ++i) mixed[j].mean += from[i] * states_[i].mean;
    for (std::size_t i = 0; i < n; ++i) {
      const TrackVector d = states_[i].mean - mixed[j].mean;
      mixed[j].covariance += from[i] * (states_[i].covariance + d * d.transpose());
    }
  }
  for (double& probability : next) probability = std::max(probability, kLeastProbability);
  normal(next);
  probability_ = std::move(next);
  states_ = std::move(mixed);
}

void TrackFilter::update(const Rows& rows, double robust_sigmas) {
  Rows weighted = rows;
  for (std::size_t i = 0; i < rows.size() && robust_sigmas > 0.0; ++i) {
    LinearRow& row = weighted[i];
    const double s = row.h.dot(estimate_.covariance * row.h) + row.variance;
    const double sigmas = std::abs(row.z - row.h.dot(estimate_.mean)) / std::sqrt(s);
    if (sigmas > robust_sigmas) row.variance += s * (sigmas / robust_sigmas - 1.0);
  }
  std::vector<double> log_likelihood(states_.size(), 0.0);
  for (std::size_t k = 0; k < states_.size(); ++k) {
    TrackState& state = states_[k];
    for (std::size_t i = 0; i < weighted.size(); ++i) {
      const LinearRow& row = weighted[i];
      const TrackVector Ph = state.covariance * row.h;
      const double s = row.h.dot(Ph) + row.variance, residual = row.z - row.h.dot(state.mean);
      log_likelihood[k] -= 0.5 * (residual * residual / s + std::log(s));
      state.mean += Ph * (residual / s);
      state.covariance -= Ph * Ph.transpose() / s;
    }
    for (const int side : {kLength, kWidth}) state.mean(side) = std::max(state.mean(side), kSmallest_m);
  }
  const double best = *std::max_element(log_likelihood.begin(), log_likelihood.end());
  for (std::size_t k = 0; k < states_.size(); ++k)
    probability_[k] = std::max(probability_[k] * std::exp(log_likelihood[k] - best), kLeastProbability);
  normal(probability_);
  combine();
}

double TrackFilter::standingProbability() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if ((*models_)[i].stands) {
      sum += probability_[i];
      continue;
    }
    const TrackState& state = states_[i];
    const double speed = state.mean.segment<2>(kVx).norm();
    const double sigma = std::sqrt(0.5 * (state.covariance(kVx, kVx) + state.covariance(kVy, kVy)));
    sum += probability_[i] * 0.5 * std::erfc((speed - kStands_mps) / (std::sqrt(2.0) * sigma));
  }
  return sum;
}

void TrackFilter::restartBox(const TrackState& born) {
  for (TrackState& state : states_) {
    for (const int i : {kPx, kPy, kLength, kWidth}) {
      state.mean(i) = born.mean(i);
      for (int j = 0; j < kTrackStates; ++j) {
        const bool moves = j == kVx || j == kVy || j == kTurnRate;
        state.covariance(i, j) = state.covariance(j, i) = moves ? 0.0 : born.covariance(i, j);
      }
    }
  }
  combine();
}

void TrackFilter::swapLengthAndWidth() {
  for (TrackState& state : states_) {
    std::swap(state.mean(kLength), state.mean(kWidth));
    state.covariance.row(kLength).swap(state.covariance.row(kWidth));
    state.covariance.col(kLength).swap(state.covariance.col(kWidth));
  }
  combine();
}

void TrackFilter::combine() {
  estimate_.mean.setZero();
  estimate_.covariance.setZero();
  for (std::size_t i = 0; i < states_.size(); ++i) estimate_.mean += probability_[i] * states_[i].mean;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const TrackVector d = states_[i].mean - estimate_.mean;
    estimate_.covariance += probability_[i] * (states_[i].covariance + d * d.transpose());
  }
}

}  // namespace atlas
