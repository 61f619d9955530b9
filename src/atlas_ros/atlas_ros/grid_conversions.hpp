// SPDX-License-Identifier: MIT
// Occupancy grids and what belongs to them as messages (compare conversions.hpp).
#pragma once

#include <atlas_msgs/CollisionRisk.h>
#include <atlas_msgs/SensorGrid.h>
#include <atlas_msgs/VelocityGrid.h>
#include <nav_msgs/OccupancyGrid.h>
#include <stereo_msgs/DisparityImage.h>

#include "atlas/base/outcome.hpp"
#include "atlas/grid/occupancy_products.hpp"
#include "atlas/sensor/sensor_grid.hpp"
#include "atlas/stereo/stereo_stage.hpp"

namespace atlas_ros {

nav_msgs::OccupancyGrid toMsg(const atlas::OccupancyMap& map);
atlas::Outcome<atlas::OccupancyMapPtr> fromMsg(const nav_msgs::OccupancyGrid& msg);
atlas_msgs::VelocityGrid toMsg(const atlas::GridVelocities& velocities);
atlas_msgs::CollisionRisk toMsg(const atlas::RiskAnswer& answer);
atlas::Outcome<atlas::RiskAnswer> fromMsg(const atlas_msgs::CollisionRisk& msg);
atlas_msgs::SensorGrid toMsg(const atlas::SensorGrid& grid);
atlas::Outcome<atlas::SensorGridPtr> fromMsg(const atlas_msgs::SensorGrid& msg);
/// 32FC1, px, a negative disparity where it is unknown (as image_pipeline has it: min_disparity - 1).
stereo_msgs::DisparityImage toMsg(const atlas::StereoDisparity& disparity);

}  // namespace atlas_ros
