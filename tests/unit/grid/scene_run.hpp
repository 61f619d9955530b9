// SPDX-License-Identifier: MIT
// A scene driven through the whole chain, and which track is which actor.
#pragma once

#include <map>
#include <optional>

#include "scene.hpp"

namespace atlas::grid_scene {

struct RunOptions {
  FilterMode mode = FilterMode::kLattice;
  SensorSet sensors;
  double step_s = 0.05;
  Pooling pooling = Pooling::kProduct;
  bool compensate_ego = true;  ///< false: the grid is told that the vehicle stands
  int threads = 1;
};

/// One answer of the chain with what was true.
struct Step {
  double t_s = 0;
  OccupancyFramePtr frame;
  /// Confirmed tracks whose middle lies in or next to each actor, by actor; nearest actor only.
  std::vector<std::vector<const Object*>> of_actor;
};

/// All steps of a scene.
[[nodiscard]] std::vector<Step> drive(const Scene& scene, const RunOptions& options);

/// The step's tracks by actor.
void assignTracks(const Scene& scene, Step& step);
/// Distance of a point from an actor's outline, 0 inside.
[[nodiscard]] double distanceTo(const Actor& actor, double t_s, const Eigen::Vector2d& point);

}  // namespace atlas::grid_scene
