// SPDX-License-Identifier: MIT
#include "synthetic/ego_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "synthetic/ground.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kCruise = 10.0;        // m/s
constexpr double kTurnSpeed = 5.5;      // m/s: 3 m/s^2 sideways at the radius below
constexpr double kTurnRadius = 10.0;    // m, tightest
constexpr double kCurvatureRamp = 6.0;  // m over which the wheel is turned
constexpr double kLane = 2.0;           // m right of the middle of the street
// pi/2 = (constant part + one ramp) / radius, as each of the two ramps counts half
constexpr double kTurnLength = kTurnRadius * M_PI / 2.0 + kCurvatureRamp;

// Septic smoothstep S(u) = 35u^4 - 84u^5 + 70u^6 - 20u^7, its integral and derivative.
double step(double u) { return u * u * u * u * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u))); }
double stepIntegral(double u) { return u * u * u * u * u * (7.0 + u * (-14.0 + u * (10.0 - 2.5 * u))); }
double stepSlope(double u) { return u * u * u * (140.0 + u * (-420.0 + u * (420.0 - 140.0 * u))); }

// Curvature and heading along a left turn of 90 degrees.
double turnCurvature(double s) {
  const double u = std::clamp(std::min(s, kTurnLength - s) / kCurvatureRamp, 0.0, 1.0);
  return step(u) / kTurnRadius;
}
double turnHeading(double s) {
  if (s > 0.5 * kTurnLength) return M_PI / 2.0 - turnHeading(kTurnLength - s);
  if (s < kCurvatureRamp) return stepIntegral(s / kCurvatureRamp) * kCurvatureRamp / kTurnRadius;
  return (s - 0.5 * kCurvatureRamp) / kTurnRadius;
}

// Position along a left turn that starts at the origin towards +x: integral of (cos, sin) of the heading, by
// 5-point Gauss-Legendre quadrature on pieces of at most 0.5 m (error below 1e-12 m).
Eigen::Vector2d turnPosition(double s) {
  constexpr double kNodes[5] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                0.9061798459386640};
  constexpr double kWeights[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                  0.4786286704993665, 0.2369268850561891};
  const int pieces = std::max(1, static_cast<int>(std::ceil(s / 0.5)));
  const double half = 0.5 * s / pieces;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < pieces; ++i) {
    for (int k = 0; k < 5; ++k) {
      const double heading = turnHeading((2 * i + 1) * half + half * kNodes[k]);
      sum += kWeights[k] * half * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    }
  }
  return sum;
}

}  // namespace

EgoMotion::EgoMotion(double duration_s, double gravity_mps2, const LongStop& stop)
    : gravity_mps2_(gravity_mps2), stop_(stop) {
  ramps_.push_back({0.0, 0.0, 0.0, 0.0, 0.0});
  segments_.push_back({0.0, 0.0, 0.5 * kBlockPitch, -kLane, 0.0, 0});
  bool left = true;
  while (ramps_.back().start_s + ramps_.back().duration_s < duration_s + 5.0 || segments_.size() < 3) {
    addCycle(left);
    left = !left;
  }
  addSegment(300.0, 0);  // for those who drive ahead
}

void EgoMotion::addRamp(double duration_s, double to_mps) {
  const SpeedRamp& last = ramps_.back();
  const double distance = last.start_m + 0.5 * (last.from_mps + last.to_mps) * last.duration_s;
  ramps_.push_back({last.start_s + last.duration_s, duration_s, last.to_mps, to_mps, distance});
}

void EgoMotion::addSegment(double length_m, int turn) {
  const Segment& last = segments_.back();
  const PathPoint end = within(last, last.length_m);
  segments_.push_back({last.start_m + last.length_m, length_m, end.x, end.y, end.yaw, turn});
}

void EgoMotion::addCycle(bool left) {
  const double reach =
      turnPosition(kTurnLength).x();  // from the start of a turn to the crossing of the lanes
  // Half a block to the crossing, where the lanes meet 2 m beyond its middle (left) or before it (right).
  const double straight = 0.5 * kBlockPitch + (left ? kLane : -kLane) - reach;
  addSegment(straight, 0);
  addSegment(kTurnLength, left ? 1 : -1);
  addSegment(straight, 0);
  const double accelerate_s = 7.0, slow_s = 2.5, leave_s = 3.5, brake_s = 5.0;
  const double changing = 0.5 * (kCruise + kTurnSpeed);
  addRamp(4.0, 0.0);
  const SpeedRamp& standing = ramps_.back();
  if (stop_.for_s > 0.0 && standing.start_s >= stop_.at_s) addRamp(std::exchange(stop_.for_s, 0.0), 0.0);
  addRamp(accelerate_s, kCruise);
  addRamp((straight - 0.5 * kCruise * accelerate_s - changing * slow_s) / kCruise, kCruise);
  addRamp(slow_s, kTurnSpeed);
  addRamp(kTurnLength / kTurnSpeed, kTurnSpeed);
  addRamp(leave_s, kCruise);
  addRamp((straight - changing * leave_s - 0.5 * kCruise * brake_s) / kCruise, kCruise);
  addRamp(brake_s, 0.0);
  addRamp(1.0, 0.0);
}

EgoMotion::Motion EgoMotion::motionAt(double t_s) const {
  if (t_s <= 0.0) return {0.0, 0.0, 0.0};
  const auto after = std::upper_bound(ramps_.begin(), ramps_.end(), t_s,
                                      [](double t, const SpeedRamp& ramp) { return t < ramp.start_s; });
  const SpeedRamp& ramp = *std::prev(after);
  if (ramp.duration_s <= 0.0) return {ramp.start_m, ramp.to_mps, 0.0};
  const double u = std::min(1.0, (t_s - ramp.start_s) / ramp.duration_s);
  const double change = ramp.to_mps - ramp.from_mps;
  return {ramp.start_m + ramp.duration_s * (ramp.from_mps * u + change * stepIntegral(u)),
          ramp.from_mps + change * step(u), change * stepSlope(u) / ramp.duration_s};
}

EgoMotion::PathPoint EgoMotion::within(const Segment& segment, double along_m) {
  const Eigen::Vector2d forward(std::cos(segment.yaw), std::sin(segment.yaw));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  if (segment.turn == 0) {
    return {segment.x + along_m * forward.x(), segment.y + along_m * forward.y(), segment.yaw, 0.0};
  }
  const Eigen::Vector2d p = turnPosition(along_m);
  const Eigen::Vector2d at = p.x() * forward + segment.turn * p.y() * left;
  return {segment.x + at.x(), segment.y + at.y(), segment.yaw + segment.turn * turnHeading(along_m),
          segment.turn * turnCurvature(along_m)};
}

EgoMotion::PathPoint EgoMotion::path(double s_m) const {
  const auto after = std::upper_bound(segments_.begin(), segments_.end(), s_m,
                                      [](double s, const Segment& segment) { return s < segment.start_m; });
  const Segment& segment = after == segments_.begin() ? segments_.front() : *std::prev(after);
  return within(segment, s_m - segment.start_m);
}

Pose EgoMotion::onGround(const PathPoint& point, double height_m) {
  const GroundPoint ground = roadSurface(point.x, point.y);
  const double c = std::cos(point.yaw), s = std::sin(point.yaw);
  const Eigen::Vector3d forward = Eigen::Vector3d(c, s, ground.slope_x * c + ground.slope_y * s).normalized();
  const Eigen::Vector3d normal = Eigen::Vector3d(-ground.slope_x, -ground.slope_y, 1.0).normalized();
  Eigen::Matrix3d R_city_vehicle;
  R_city_vehicle << forward, normal.cross(forward), normal;
  return {Eigen::Quaterniond(R_city_vehicle).normalized(), {point.x, point.y, ground.height + height_m}};
}

Pose EgoMotion::T_city_imu(double t_s) const {
  const Motion motion = motionAt(t_s);
  const PathPoint point = path(motion.distance);
  const double sideways = motion.speed * motion.speed * point.curvature;  // m/s^2 to the left
  const double moving = motion.speed / kCruise;
  // Suspension: nose down (pitch > 0) when braking, left side up (roll > 0) in a left turn; unevenness over
  // arc length.
  const double pitch =
      -0.006 * motion.acceleration + 0.0015 * moving * std::sin(2.0 * M_PI * motion.distance / 7.3);
  const double roll = 0.008 * sideways + 0.002 * moving * std::sin(2.0 * M_PI * motion.distance / 9.1 + 1.0);
  const double heave = 0.004 * moving * std::sin(2.0 * M_PI * motion.distance / 5.7);
  Pose pose = onGround(point, kImuHeight + heave);
  pose.rotation = (pose.rotation * fromRollPitchYaw({roll, pitch, 0.0})).normalized();
  return pose;
}

ImuKinematics EgoMotion::kinematics(double t_s) const {
  constexpr double kStep = 0.004;  // s: rounding (1e-13 m / h^2) and truncation are both far below the noise
  const Pose here = T_city_imu(t_s);
  Eigen::Vector3d rotation[7], position[7];
  for (int k = 0; k < 7; ++k) {
    const Pose near = k == 3 ? here : T_city_imu(t_s + (k - 3) * kStep);
    rotation[k] = logSo3(here.rotation.conjugate() * near.rotation);
    position[k] = near.translation;
  }
  // f' = (45 (f1 - f-1) - 9 (f2 - f-2) + (f3 - f-3)) / 60h,
  // f'' = (2 (f3 + f-3) - 27 (f2 + f-2) + 270 (f1 + f-1) - 490 f0) / 180h^2 (Fornberg 1988, table 1)
  const Eigen::Vector3d omega =
      (45.0 * (rotation[4] - rotation[2]) - 9.0 * (rotation[5] - rotation[1]) + (rotation[6] - rotation[0])) /
      (60.0 * kStep);
  const auto& p = position;
  const Eigen::Vector3d acceleration = (2.0 * (p[6] + p[0] - 2.0 * p[3]) - 27.0 * (p[5] + p[1] - 2.0 * p[3]) +
                                        270.0 * (p[4] + p[2] - 2.0 * p[3])) /
                                       (180.0 * kStep * kStep);
  const Eigen::Vector3d force = acceleration + Eigen::Vector3d(0.0, 0.0, gravity_mps2_);
  return {omega, here.rotation.conjugate() * force};
}

}  // namespace atlas::synthetic
