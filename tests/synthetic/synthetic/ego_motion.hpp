// SPDX-License-Identifier: MIT
// The motion of the vehicle as a smooth function of time: pose, and from it what an ideal IMU measures.
// Route in cycles of about 30 s: stand 4 s, accelerate to 10 m/s, slow down, turn 90 degrees (left, right,
// left, ...), accelerate, brake to standstill. Speed over time and curvature over arc length are joined by
// septic smoothsteps (continuous third derivative), attitude follows the ground, the accelerations
// (suspension) and the road's unevenness.
#pragma once

#include <vector>

#include "atlas/base/geometry.hpp"

namespace atlas::synthetic {

/// What an ideal IMU measures on an Earth that does not rotate, imu frame; ImuModel adds the rotation.
struct ImuKinematics {
  Eigen::Vector3d angular_velocity_radps;
  Eigen::Vector3d specific_force_mps2;  ///< points up at rest
};

/// A red light: the first standstill that begins at or after `at_s` lasts `for_s` longer.
struct LongStop {
  double at_s = 0.0, for_s = 0.0;
};

class EgoMotion {
 public:
  /// Route for at least `duration_s` seconds (no end is visible before). gravity_mps2 > 0 points down.
  EgoMotion(double duration_s, double gravity_mps2, const LongStop& stop = {});

  /// T_city_imu at t seconds after the start of the route; stands still before 0.
  [[nodiscard]] Pose T_city_imu(double t_s) const;
  /// By sixth-order central differences of T_city_imu (step 4 ms; error below 1e-6 m/s^2 and 1e-8 rad/s).
  [[nodiscard]] ImuKinematics kinematics(double t_s) const;
  [[nodiscard]] double speed(double t_s) const { return motionAt(t_s).speed; }
  [[nodiscard]] double arcLength(double t_s) const { return motionAt(t_s).distance; }

  /// Point and direction of the lane at arc length s, city frame.
  struct PathPoint {
    double x, y, yaw, curvature;
  };
  [[nodiscard]] PathPoint path(double s_m) const;
  /// T_city_vehicle of a car whose origin is `height_m` above the road at a path point, following the ground.
  [[nodiscard]] static Pose onGround(const PathPoint& point, double height_m);
  [[nodiscard]] double length() const { return segments_.back().start_m + segments_.back().length_m; }

  static constexpr double kImuHeight = 1.75;  ///< m above the road: the rig sits on the roof

 private:
  struct Motion {
    double distance, speed, acceleration;
  };
  struct SpeedRamp {
    double start_s, duration_s, from_mps, to_mps, start_m;
  };
  struct Segment {
    double start_m, length_m, x, y, yaw;
    int turn;  ///< +1 left, -1 right, 0 straight
  };
  void addRamp(double duration_s, double to_mps);
  void addSegment(double length_m, int turn);
  void addCycle(bool left);
  [[nodiscard]] Motion motionAt(double t_s) const;
  [[nodiscard]] static PathPoint within(const Segment& segment, double along_m);

  double gravity_mps2_;
  LongStop stop_;  ///< for_s becomes 0 when it is part of the route
  std::vector<SpeedRamp> ramps_;
  std::vector<Segment> segments_;
};

}  // namespace atlas::synthetic
