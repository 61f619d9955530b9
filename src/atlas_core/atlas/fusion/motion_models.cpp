// SPDX-License-Identifier: MIT
// The ways to move. White acceleration of density q adds over dt: q^2 dt^3/3 to the variance of a position,
// q^2 dt^2/2 to its covariance with the velocity, q^2 dt to that of the velocity (Bar-Shalom, Li,
// Kirubarajan 2001, "Estimation with Applications to Tracking and Navigation", eq. 6.2.2-12; the turn:
// section 11.7.1).
#include <cmath>

#include "atlas/fusion/track_filter.hpp"

namespace atlas {
namespace {

constexpr double kRestSpeed_mps = 0.03;  ///< of an object that stands: what the map's own error moves it
constexpr double kRestDrift_m_sqrt_s = 0.03;
constexpr double kStraight_radps = 0.02;     ///< turn rate of what drives straight
constexpr double kSizeWalk_m_sqrt_s = 0.02;  ///< bodies are rigid, their outlines not quite

void addWhiteAcceleration(TrackMatrix& P, double q, double dt) {
  const double q_sq = q * q;
  for (const auto& [p, v] : {std::pair<int, int>{kPx, kVx}, std::pair<int, int>{kPy, kVy}}) {
    P(p, p) += q_sq * dt * dt * dt / 3.0;
    P(p, v) += q_sq * dt * dt / 2.0;
    P(v, p) += q_sq * dt * dt / 2.0;
    P(v, v) += q_sq * dt;
  }
}
void addSizeWalk(TrackMatrix& P, double dt) {
  for (const int i : {kLength, kWidth}) P(i, i) += kSizeWalk_m_sqrt_s * kSizeWalk_m_sqrt_s * dt;
}
/// The state is known to have this value, whatever it was.
void reset(TrackState& state, int index, double value, double sigma) {
  state.mean(index) = value;
  state.covariance.row(index).setZero();
  state.covariance.col(index).setZero();
  state.covariance(index, index) = sigma * sigma;
}

}  // namespace

MotionModel standing() {
  return {"standing", true, [](TrackState& state, double dt, const MotionNoise&) {
            for (const int v : {kVx, kVy}) reset(state, v, 0.0, kRestSpeed_mps);
            reset(state, kTurnRate, 0.0, kStraight_radps);
            for (const int p : {kPx, kPy})
              state.covariance(p, p) += kRestDrift_m_sqrt_s * kRestDrift_m_sqrt_s * dt;
            addSizeWalk(state.covariance, dt);
          }};
}

MotionModel constantVelocity() {
  return {"constant_velocity", false, [](TrackState& state, double dt, const MotionNoise& noise) {
            TrackMatrix F = TrackMatrix::Identity();
            F(kPx, kVx) = F(kPy, kVy) = dt;
            state.mean = F * state.mean;
            state.covariance = F * state.covariance * F.transpose();
            reset(state, kTurnRate, 0.0, kStraight_radps);
            addWhiteAcceleration(state.covariance, noise.acceleration_mps2_sqrt_s, dt);
            addSizeWalk(state.covariance, dt);
          }};
}

MotionModel constantTurn() {
  return {"constant_turn", false, [](TrackState& state, double dt, const MotionNoise& noise) {
            const double w = state.mean(kTurnRate), angle = w * dt;
            const bool small = std::abs(angle) < 1e-4;  // series where the quotients lose digits
            const double c = std::cos(angle), s = std::sin(angle);
            const double S = small ? dt : s / w, C = small ? 0.5 * angle * dt : (1.0 - c) / w;
            const double dS = small ? -angle * dt * dt / 3.0 : (dt * c - S) / w;
            const double dC = small ? 0.5 * dt * dt : (dt * s - C) / w;
            const double vx = state.mean(kVx), vy = state.mean(kVy);
            TrackMatrix F = TrackMatrix::Identity();
            F.block<2, 2>(kPx, kVx) << S, -C, C, S;
            F.block<2, 2>(kVx, kVx) << c, -s, s, c;
            F(kPx, kTurnRate) = dS * vx - dC * vy;
            F(kPy, kTurnRate) = dC * vx + dS * vy;
            F(kVx, kTurnRate) = dt * (-s * vx - c * vy);
            F(kVy, kTurnRate) = dt * (c * vx - s * vy);
            state.mean.head<4>() << state.mean(kPx) + S * vx - C * vy, state.mean(kPy) + C * vx + S * vy,
                c * vx - s * vy, s * vx + c * vy;
            state.covariance = F * state.covariance * F.transpose();
            addWhiteAcceleration(state.covariance, noise.acceleration_mps2_sqrt_s, dt);
            const double q = noise.turn_acceleration_radps2_sqrt_s;
            state.covariance(kTurnRate, kTurnRate) += q * q * dt;
            addSizeWalk(state.covariance, dt);
          }};
}

MotionModels motionModels() { return {standing(), constantVelocity(), constantTurn()}; }

}  // namespace atlas
