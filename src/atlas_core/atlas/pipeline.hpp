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
//   objects, cloud, frustums, odometry   -> local_map    -> local_map
//   <camera>/frustums, IR camera_info,
//   batches                              -> thermal      -> camera_ir/projected_detections
//   batches, <camera>/camera_info        -> depth        -> <camera>/depth/image
//
// Each bindXxx names a stage's inputs and outputs once. The nodelets bind the same functions to topics
// (atlas_ros::StageLink), the offline replay binds them to a LocalGraph: the two cannot drift apart.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/bus.hpp"
#include "atlas/base/local_graph.hpp"
#include "atlas/camera/camera_lidar_stage.hpp"
#include "atlas/camera/depth_stage.hpp"
#include "atlas/camera/thermal_stage.hpp"
#include "atlas/fusion/local_map.hpp"
#include "atlas/fusion/object_stage.hpp"
#include "atlas/lidar/aggregate_stage.hpp"
#include "atlas/lidar/deskew_stage.hpp"
#include "atlas/lidar/line_stage.hpp"
#include "atlas/lidar/obstacle_stage.hpp"
#include "atlas/localization/localization_stage.hpp"
#include "atlas/monitor/monitor_stage.hpp"

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
  LocalMapParams local_map;
  ThermalParams thermal;
  DepthParams depth;
};

/// Transforms that never change count before every other event.
constexpr Stamp kStaticStamp = 0;

/// Adds the main stages to a graph, in order of the data path.
void addPipeline(LocalGraph& graph, const PipelineParams& params);

template <class StageType, class Bus>
void rigAndOdometry(Bus& bus) {
  bus.template input<StageType, StaticTransforms>(
      0, "tf_static", [](StageType& s, const StaticTransforms& t) { s.push(kStaticStamp, t); });
  bus.template input<StageType, Odometry>(1, "odometry", [](StageType& s, const Odometry& o) { s.push(o); });
}

/// For stages that gate on the scores of sensors.
template <class StageType, class Bus>
void sensorStatus(Bus& bus, std::size_t input) {
  bus.template input<StageType, SensorStatus>(
      input, "sensor_status", [](StageType& s, const SensorStatus& status) { s.push(status); });
}

template <class Bus>
StageFactory bindMonitor(Bus& bus, const MonitorParams& params) {
  using S = MonitorStage;
  validate(params);
  const MonitorStage::Inputs first(params);
  bus.template input<S, StaticTransforms>(S::kTfStatic, "tf_static",
                                          [](S& s, const StaticTransforms& t) { s.push(kStaticStamp, t); });
  bus.template input<S, ImuSample>(S::kImu, "imu/data", [](S& s, const ImuSample& imu) { s.push(imu); });
  bus.template input<S, MagneticSample>(S::kMagnetic, "imu/mag",
                                        [](S& s, const MagneticSample& field) { s.push(field); });
  bus.template input<S, ScalarSample>(S::kPressure, "imu/pressure",
                                      [](S& s, const ScalarSample& pressure) { s.push(pressure); });
  bus.template input<S, GnssFix>(S::kFix, "gnss/fix", [](S& s, const GnssFix& fix) { s.push(fix); });
  bus.template input<S, GnssHeading>(S::kHeading, "gnss/heading",
                                     [](S& s, const GnssHeading& h) { s.push(h); });
  bus.template input<S, GnssFix>(S::kSecondFix, "imu/gnss/fix",
                                 [](S& s, const GnssFix& fix) { s.pushSecond(fix); });
  std::vector<std::pair<std::size_t, std::string>> clocks = {{S::kImuTime, "imu/time"},
                                                             {S::kFixTime, "gnss/time"}};
  for (std::size_t i = 0; i < params.lidars.size(); ++i)
    clocks.emplace_back(first.times + i, params.lidars[i] + "/time");
  for (const auto& [index, topic] : clocks) {
    bus.template input<S, TimeReference>(index, topic, [index = index](S& s, const TimeReference& reference) {
      s.pushTime(index, reference);
    });
  }
  inputs<S, SweepPtr>(bus, first.points, params.lidars, "/points");
  inputs<S, CameraInfo>(bus, first.infos, params.cameras, "/camera_info");
  inputs<S, ImagePtr>(bus, first.images, params.cameras, "/image");
  inputs<S, TemperatureRange>(bus, first.ranges, params.thermal_cameras, "/temperature_range");
  inputs<S, RadarScan>(bus, first.scans, params.radars, "/scan");
  const auto status = bus.template output<SensorStatus>("sensor_status");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_status = status;
    return stage;
  };
}

template <class Bus>
StageFactory bindLocalization(Bus& bus, const LocalizationParams& params) {
  using S = LocalizationStage;
  validate(params);
  const auto at = [&params](typename S::Input input) { return S::gatedInput(params, input); };
  bus.template input<S, StaticTransforms>(S::kTfStatic, "tf_static",
                                          [](S& s, const StaticTransforms& t) { s.push(kStaticStamp, t); });
  if (!params.gate_on_sensors.empty()) sensorStatus<S>(bus, S::kGateStatus);
  bus.template input<S, GnssFix>(at(S::kGnssFix), "gnss/fix", [](S& s, const GnssFix& fix) { s.push(fix); });
  bus.template input<S, GnssHeading>(at(S::kGnssHeading), "gnss/heading",
                                     [](S& s, const GnssHeading& h) { s.push(h); });
  bus.template input<S, ImuSample>(at(S::kImu), "imu/data", [](S& s, const ImuSample& imu) { s.push(imu); });
  if (params.receivers.second_receiver) {
    bus.template input<S, GnssFix>(at(S::kSecondFix), "imu/gnss/fix",
                                   [](S& s, const GnssFix& fix) { s.pushSecond(fix); });
  }
  if (params.barometer.barometer) {
    bus.template input<S, ScalarSample>(at(S::kPressure), "imu/pressure",
                                        [](S& s, const ScalarSample& pressure) { s.pushPressure(pressure); });
  }
  const auto odometry = bus.template output<Odometry>("odometry");
  const auto anchor = bus.template output<Anchor>("anchor");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_odometry = odometry;
    stage->on_anchor = anchor;
    return stage;
  };
}

template <class Bus>
StageFactory bindDeskew(Bus& bus, const DeskewParams& params) {
  using S = DeskewStage;
  validate(params);
  rigAndOdometry<S>(bus);
  inputs<S, SweepPtr>(bus, S::kFirstLidar, params.lidars, "/points");
  const auto batches = outputs<BatchedSweepPtr>(bus, params.lidars, "/batches");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_batches = batches;
    return stage;
  };
}

template <class Bus>
StageFactory bindAggregate(Bus& bus, const AggregateParams& params) {
  using S = AggregateStage;
  validate(params);
  inputs<S, BatchedSweepPtr>(bus, 0, params.lidars, "/batches");
  const auto cloud = bus.template output<MapCloudPtr>("cloud");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_cloud = cloud;
    return stage;
  };
}

template <class Bus>
StageFactory bindObstacles(Bus& bus, const ObstacleParams& params) {
  using S = ObstacleStage;
  validate(params);
  bus.template input<S, Odometry>(S::kOdometry, "odometry", [](S& s, const Odometry& o) { s.push(o); });
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  const auto obstacles = bus.template output<Obstacles>("obstacles");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_obstacles = obstacles;
    return stage;
  };
}

template <class Bus>
StageFactory bindLines(Bus& bus, const LineParams& params) {
  validate(params);
  inputs<LineStage, BatchedSweepPtr>(bus, 0, params.lidars, "/batches");
  return [params, lines = outputs<Lines>(bus, params.lidars, "/lines")] {
    auto stage = std::make_unique<LineStage>(params);
    stage->on_lines = lines;
    return stage;
  };
}

template <class Bus>
StageFactory bindCameraLidar(Bus& bus, const CameraLidarParams& params) {
  using S = CameraLidarStage;
  validate(params);
  const std::size_t first_info = S::kFirstLidar + params.lidars.size();
  rigAndOdometry<S>(bus);
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  inputs<S, CameraInfo>(bus, first_info, params.cameras, "/camera_info");
  const std::size_t gate = first_info + params.cameras.size();
  const bool gated = !params.gate_on_sensors.empty();
  if (gated) sensorStatus<S>(bus, gate);
  inputs<S, Detections>(bus, gate + (gated ? 1 : 0), params.cameras, "/detections");
  const auto frustums = outputs<Frustums>(bus, params.cameras, "/frustums");
  const auto merged = bus.template output<Frustums>("frustums");
  const auto origins = bus.template output<ProductOrigins>("camera_lidar/origins");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_frustums = frustums;
    stage->on_merged = merged;
    stage->on_origins = origins;
    return stage;
  };
}

template <class Bus>
StageFactory bindObjects(Bus& bus, const ObjectParams& params) {
  using S = ObjectStage;
  validate(params);
  const std::size_t obstacles = S::kFirstLidar + params.lidars.size();
  rigAndOdometry<S>(bus);
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  bus.template input<S, Obstacles>(obstacles, "obstacles", [](S& s, const Obstacles& o) { s.push(o); });
  if (params.use_frustums)
    bus.template input<S, Frustums>(obstacles + 1, "frustums", [](S& s, const Frustums& f) { s.push(f); });
  inputs<S, RadarScan>(bus, obstacles + (params.use_frustums ? 2 : 1), params.radars, "/scan");
  const auto objects = bus.template output<ObjectsPtr>("objects");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_objects = objects;
    return stage;
  };
}

template <class Bus>
StageFactory bindLocalMap(Bus& bus, const LocalMapParams& params) {
  using S = LocalMapStage;
  validate(params);
  bus.template input<S, Odometry>(S::kOdometry, "odometry", [](S& s, const Odometry& o) { s.push(o); });
  bus.template input<S, ObjectsPtr>(S::kObjects, "objects", [](S& s, const ObjectsPtr& o) { s.push(o); });
  bus.template input<S, MapCloudPtr>(S::kCloud, "cloud", [](S& s, const MapCloudPtr& c) { s.push(c); });
  bus.template input<S, Frustums>(S::kFrustums, "frustums", [](S& s, const Frustums& f) { s.push(f); });
  const auto map = bus.template output<LocalMapView>("local_map");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_map = map;
    return stage;
  };
}

template <class Bus>
StageFactory bindThermal(Bus& bus, const ThermalParams& params) {
  using S = ThermalStage;
  validate(params);
  rigAndOdometry<S>(bus);
  bus.template input<S, CameraInfo>(S::kThermalInfo, params.thermal_camera + "/camera_info",
                                    [](S& s, const CameraInfo& info) { s.pushThermal(info); });
  inputs<S, Frustums>(bus, S::kFirstCamera, params.cameras, "/frustums");
  inputs<S, BatchedSweepPtr>(bus, S::kFirstCamera + params.cameras.size(), params.lidars, "/batches");
  const auto projected =
      bus.template output<ProjectedDetections>(params.thermal_camera + "/projected_detections");
  const auto origins = bus.template output<ProductOrigins>("thermal/origins");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_projected = projected;
    stage->on_origins = origins;
    return stage;
  };
}

template <class Bus>
StageFactory bindDepth(Bus& bus, const DepthParams& params) {
  using S = DepthStage;
  validate(params);
  rigAndOdometry<S>(bus);
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  inputs<S, CameraInfo>(bus, S::kFirstLidar + params.lidars.size(), params.cameras, "/camera_info");
  const auto depth = outputs<DepthImagePtr>(bus, params.names(), "/depth/image");
  const auto confidence = outputs<DepthImagePtr>(bus, params.names(), "/depth/confidence");
  const auto origins = bus.template output<ProductOrigins>("depth/origins");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_depth = depth;
    stage->on_confidence = confidence;
    stage->on_origins = origins;
    return stage;
  };
}

}  // namespace atlas
