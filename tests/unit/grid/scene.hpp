// SPDX-License-Identifier: MIT
// A street of boxes seen by the second paper's sensors: two lidars with four layers in the bumper and a
// stereo camera behind the windscreen. Everything is cast exactly; the noise is a function of its place and a
// seed, so that each frame can be made on its own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "atlas/grid/occupancy_chain.hpp"
#include "atlas/stereo/stereo_ground.hpp"

namespace atlas::grid_scene {

struct Placing {
  double x = 0, y = 0, yaw = 0;  ///< m, rad, map
};

/// A box on or above the road; its path is that of its middle.
struct Actor {
  std::string name;
  double length = 4.4, width = 1.8;
  double bottom = 0.0, top = 1.5;  ///< m above the road
  std::function<Placing(double t_s)> path;
  [[nodiscard]] Placing at(double t_s) const { return path(t_s); }
  [[nodiscard]] Eigen::Vector2d velocityAt(double t_s) const;
};
std::function<Placing(double)> stands(double x, double y, double yaw = 0.0);
/// Straight on from (x, y) along yaw.
std::function<Placing(double)> drives(double x, double y, double yaw, double speed_mps);

struct Scene {
  std::vector<Actor> actors;
  std::function<Placing(double)> ego = stands(0.0, 0.0);  ///< of base_link
  std::function<double(double)> pitch_rad;                ///< of the vehicle's body, nose down positive
  double duration_s = 4.0;
};

struct SensorSet {
  bool lidars = true, stereo = true;
  double range_sigma_m = 0.05, drop_out = 0.02;
  double disparity_sigma_px = 0.25, outliers = 0.03, missing = 0.3;
  unsigned seed = 1;
};

/// Where base_link is at a time; it lies kBaseHeight_m above the road.
constexpr double kBaseHeight_m = 0.5;
[[nodiscard]] Pose egoPose(const Scene& scene, double t_s);
[[nodiscard]] Odometry egoOdometry(const Scene& scene, double t_s, Stamp stamp);

[[nodiscard]] LidarLayers scanOf(const Scene& scene, const SensorSet& sensors, int lidar, double t_s,
                                 Stamp stamp);

/// The stereo camera with its grid on the ground.
class StereoEye {
 public:
  StereoEye();
  [[nodiscard]] PlacedGrid look(const Scene& scene, const SensorSet& sensors, double t_s, Stamp stamp);

 private:
  StereoRig rig_;
  UDisparityParams params_;
  GroundCells cells_;
  UDisparity u_disparity_;
  StereoGround ground_;
};

/// Nothing but a car that stands 14 m ahead.
[[nodiscard]] Scene carAhead();

/// Parameters of the chain for these sensors.
[[nodiscard]] OccupancyParams paramsFor(FilterMode mode);

}  // namespace atlas::grid_scene
