// SPDX-License-Identifier: MIT
// What is told of an object (paper III-E: "geometrical shape information, object type, kinematic model,
// motion history"): by the objects aggregator, and by the tracker of the occupancy grid.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/time.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

/// Where an object was.
struct ObjectPast {
  Stamp stamp = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity_mps = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};
struct Object {
  std::uint32_t id = 0;
  std::int32_t class_id = -1;      ///< COCO-80 index of the likeliest class, -1 = none of the known ones
  double class_probability = 0.0;  ///< of class_id (of "none" for -1)
  std::vector<double> class_probabilities;             ///< of each configured class, then of "none of them"
  double existence = 0.0;                              ///< probability that there is such an object
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, map: middle of the box
  double yaw_rad = 0.0;                                ///< of the length axis, map; forward when it is known
  bool heading_known = false;                      ///< false: yaw_rad may as well be turned by half a turn
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< length, width, height, m
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< map
  double yaw_rate_radps = 0.0;
  /// Of (x, y, vx, vy, yaw rate), row-major; SI.
  std::array<double, 25> covariance{};
  double z_variance_m2 = 0.0, yaw_variance_rad2 = 0.0;
  double static_probability = 0.0;
  bool is_static = false;
  double age_s = 0.0;               ///< since the first measurement
  double unseen_s = 0.0;            ///< since the last one
  double detectability = 0.0;       ///< probability that the last lidar sweep would have shown it: 0 = hidden
  double score = 0.0;               ///< mean of the scores of its detections, where they have any
  std::vector<Origin> sources;      ///< obstacles, frustums and targets since the update before
  std::vector<ObjectPast> history;  ///< oldest first
};
struct Objects {
  Stamp stamp = 0;
  std::optional<Pose> T_map_imu;  ///< of the vehicle, when it was known
  std::vector<Object> objects;    ///< by id
};
using ObjectsPtr = std::shared_ptr<const Objects>;

}  // namespace atlas
