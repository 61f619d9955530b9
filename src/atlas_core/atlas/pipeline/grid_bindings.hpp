// SPDX-License-Identifier: MIT
// Inputs and outputs of the second paper's system: stereo camera and occupancy filter.
#pragma once

#include <memory>
#include <tuple>

#include "atlas/grid/occupancy_products.hpp"
#include "atlas/grid/occupancy_stage.hpp"
#include "atlas/pipeline/common_bindings.hpp"
#include "atlas/stereo/stereo_stage.hpp"

namespace atlas {

template <class Bus>
StageFactory bindStereo(Bus& bus, const StereoStageParams& params) {
  using S = StereoStage;
  validate(params);
  bus.template input<S, StaticTransforms>(S::kTfStatic, "tf_static",
                                          [](S& s, const StaticTransforms& t) { s.push(kStaticStamp, t); });
  for (const auto& [info, image, camera] : {std::tuple{S::kLeftInfo, S::kLeft, params.left_camera},
                                            {S::kRightInfo, S::kRight, params.right_camera}}) {
    bus.template input<S, CameraInfo>(info, camera + "/camera_info",
                                      [info = info](S& s, const CameraInfo& i) { s.pushInfo(info, i); });
    bus.template input<S, ImagePtr>(image, camera + "/image",
                                    [image = image](S& s, const ImagePtr& i) { s.pushImage(image, i); });
  }
  const auto disparity = bus.template output<StereoDisparityPtr>(params.name + "/disparity");
  const auto surface = bus.template output<ImagePtr>(params.name + "/surface");
  const auto u_disparity = bus.template output<ImagePtr>(params.name + "/u_disparity");
  const auto ground = bus.template output<SensorGridPtr>(params.name + "/ground");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_disparity = disparity;
    stage->on_surface = surface;
    stage->on_u_disparity = u_disparity;
    stage->on_ground = ground;
    return stage;
  };
}

template <class Bus>
StageFactory bindOccupancy(Bus& bus, const OccupancyParams& params) {
  using S = OccupancyStage;
  validate(params);
  rigAndOdometry<S>(bus);
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  inputs<S, SensorGridPtr>(bus, S::kFirstLidar + params.lidars.size(), params.stereo, "/ground");
  const auto grid = bus.template output<OccupancyMapPtr>("grid");
  const auto velocity = bus.template output<GridVelocities>("grid/velocity");
  const auto objects = bus.template output<ObjectsPtr>("grid/objects");
  const auto risk = bus.template output<RiskAnswer>("grid/risk");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_frame = [=](const OccupancyFramePtr& frame) {
      grid(occupancyMap(*frame, params.unknown_above));
      velocity({frame});
      objects(ObjectsPtr(frame, &frame->objects));
      risk({frame->stamp, frame->risk});
    };
    return stage;
  };
}

}  // namespace atlas
