// SPDX-License-Identifier: MIT
#include "scene_run.hpp"

#include <algorithm>
#include <cmath>

namespace atlas::grid_scene {
namespace {

constexpr Stamp kStart = 1'500'000'000 * kSecond;
constexpr double kBeside_m = 0.7;  ///< a track whose middle lies farther from an actor is none of it

/// What a vehicle believes that thinks it stands: everything moves around it.
Pose seenStanding(const Scene& scene, double t_s, const Pose& T_map_sensor) {
  return egoPose(scene, t_s).inverse() * T_map_sensor;
}

void withoutEgoMotion(const Scene& scene, double t_s, OccupancyInput& input) {
  const double yaw = scene.ego(t_s).yaw;
  for (LidarLayers& lidar : input.lidars) {
    lidar.T_map_lidar = seenStanding(scene, t_s, lidar.T_map_lidar);
    lidar.T_map_lidar.translation.z() += kBaseHeight_m;
    for (LidarLayer& layer : lidar.layers) {
      for (LayerBeam& beam : layer.beams)
        beam.azimuth_rad = static_cast<float>(std::remainder(beam.azimuth_rad - yaw, 2.0 * M_PI));
    }
  }
  for (PlacedGrid& grid : input.grids) grid.T_map_grid = seenStanding(scene, t_s, grid.T_map_grid);
  input.T_map_imu = Pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, kBaseHeight_m}};
}

}  // namespace

double distanceTo(const Actor& actor, double t_s, const Eigen::Vector2d& point) {
  const Placing at = actor.at(t_s);
  const double c = std::cos(at.yaw), s = std::sin(at.yaw), dx = point.x() - at.x, dy = point.y() - at.y;
  const double along = std::max(0.0, std::abs(c * dx + s * dy) - 0.5 * actor.length);
  const double across = std::max(0.0, std::abs(c * dy - s * dx) - 0.5 * actor.width);
  return std::hypot(along, across);
}

void assignTracks(const Scene& scene, Step& step) {
  step.of_actor.assign(scene.actors.size(), {});
  for (const Object& object : step.frame->objects.objects) {
    double least = kBeside_m;
    std::size_t nearest = scene.actors.size();
    for (std::size_t a = 0; a < scene.actors.size(); ++a) {
      const double distance = distanceTo(scene.actors[a], step.t_s, object.position.head<2>());
      if (distance >= least) continue;
      least = distance;
      nearest = a;
    }
    if (nearest < scene.actors.size()) step.of_actor[nearest].push_back(&object);
  }
}

std::vector<Step> drive(const Scene& scene, const RunOptions& options) {
  OccupancyParams params = paramsFor(options.mode);
  params.pooling = options.pooling;
  params.threads = options.threads;
  OccupancyChain chain(params);
  Counters counters;
  StereoEye eye;
  std::vector<Step> steps;
  const int count = static_cast<int>(std::lround(scene.duration_s / options.step_s));
  for (int k = 0; k <= count; ++k) {
    Step step;
    step.t_s = k * options.step_s;
    OccupancyInput input;
    input.stamp = kStart + fromSeconds(step.t_s);
    input.T_map_imu = egoPose(scene, step.t_s);
    input.motion = egoOdometry(scene, step.t_s, input.stamp);
    for (int lidar = 0; options.sensors.lidars && lidar < 2; ++lidar)
      input.lidars.push_back(scanOf(scene, options.sensors, lidar, step.t_s, input.stamp));
    if (options.sensors.stereo)
      input.grids.push_back(eye.look(scene, options.sensors, step.t_s, input.stamp));
    if (!options.compensate_ego) withoutEgoMotion(scene, step.t_s, input);
    step.frame = chain.update(input, counters);
    assignTracks(scene, step);
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace atlas::grid_scene
