// SPDX-License-Identifier: MIT
// Inputs and outputs of the stages of the cameras.
#pragma once

#include <memory>

#include "atlas/camera/camera_lidar_stage.hpp"
#include "atlas/camera/depth_stage.hpp"
#include "atlas/camera/thermal_stage.hpp"
#include "atlas/pipeline/common_bindings.hpp"

namespace atlas {

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
