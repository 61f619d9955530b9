// SPDX-License-Identifier: MIT
// The whole data path in order: the first file to read.
//
//   all raw data                         -> monitor      -> sensor_status
//   imu/data, gnss/fix, gnss/heading,
//   imu/gnss/fix (second receiver),
//   imu/pressure (if asked for)          -> localization -> odometry
//   <lidar>/points, odometry             -> deskew       -> <lidar>/batches
//   <lidar>/batches                      -> aggregate    -> cloud
//   <lidar>/batches, odometry            -> obstacles    -> obstacles
//   <lidar>/batches (if asked for)       -> lines        -> <lidar>/lines
//   <camera>/detections, batches         -> camera_lidar -> <camera>/frustums,
//                                                           frustums (all cameras, merged)
//   obstacles, frustums, <radar>/scan,
//   batches, odometry                    -> objects      -> objects
//   images of two cameras (if asked for) -> stereo       -> stereo/disparity, stereo/surface,
//                                                           stereo/u_disparity, stereo/ground
//   batches, stereo/ground, odometry     -> occupancy    -> grid, grid/velocity, grid/objects,
//                                                           grid/risk
//   objects, cloud, frustums, grid,
//   odometry                             -> local_map    -> local_map
//   <camera>/frustums, IR camera_info,
//   batches                              -> thermal      -> camera_ir/projected_detections
//   batches, <camera>/camera_info        -> depth        -> <camera>/depth/image
//
// Each bindXxx (pipeline/*_bindings.hpp) names a stage's inputs and outputs once. The nodelets bind the same
// functions to topics (atlas_ros::StageLink), the offline replay binds them to a LocalGraph: the two cannot
// drift apart.
#pragma once

#include <optional>

#include "atlas/pipeline/camera_bindings.hpp"
#include "atlas/pipeline/grid_bindings.hpp"
#include "atlas/pipeline/lidar_bindings.hpp"
#include "atlas/pipeline/positioning_bindings.hpp"
#include "atlas/pipeline/scene_bindings.hpp"

namespace atlas {

struct PipelineParams {
  MonitorParams monitor;
  LocalizationParams localization;
  DeskewParams deskew;
  AggregateParams aggregate;
  ObstacleParams obstacles;
  std::optional<LineParams> lines;  ///< none: no such stage
  CameraLidarParams camera_lidar;
  ObjectParams objects;
  std::optional<StereoStageParams> stereo;  ///< none: no such stage
  OccupancyParams occupancy;
  LocalMapParams local_map;
  ThermalParams thermal;
  DepthParams depth;
};

/// Adds the main stages to a graph, in order of the data path.
void addPipeline(LocalGraph& graph, const PipelineParams& params);

}  // namespace atlas
