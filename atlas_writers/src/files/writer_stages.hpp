// SPDX-License-Identifier: MIT
// The writers as stages: inputs merged by event time like everywhere, files opened below one output folder.
// The nodelets and the offline replay bind the same functions (see atlas/pipeline.hpp), so both write the
// same bytes.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "atlas/pipeline.hpp"
#include "files/cloud_writer.hpp"
#include "files/depth_writer.hpp"
#include "files/frustum_writer.hpp"
#include "files/grid_writer_stage.hpp"
#include "files/line_writer.hpp"
#include "files/map_writer_stage.hpp"
#include "files/object_writer.hpp"
#include "files/obstacle_writer.hpp"
#include "files/overlay_writer.hpp"
#include "files/status_writer.hpp"
#include "files/thermal_writer.hpp"
#include "files/trace_writer.hpp"
#include "files/trajectory_writer.hpp"

namespace atlas {

struct TrajectoryWriterParams {};
struct ObstacleWriterParams {};
struct ObjectWriterParams {};
struct CloudWriterParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
};
struct LineWriterParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
};
struct DepthWriterParams {
  std::vector<std::string> cameras = {"camera_ir"};
  int preview_period = 10;  ///< every n-th image of a camera also as 8-bit preview
};
struct FrustumWriterParams {
  std::vector<std::string> cameras;
};
struct ThermalWriterParams {
  std::string thermal_camera = "camera_ir";
  ThermalDatasetParams dataset;
};

struct WriterParams {
  bool write_deskewed = false, write_lines = false;
  CloudWriterParams cloud;
  LineWriterParams line;
  MapWriterParams map;
  DepthWriterParams depth;
  FrustumWriterParams frustum;
  GridWriterParams grid;
  ThermalWriterParams thermal;
  OverlayWriterParams overlay;
};

/// A stage that is destroyed before its inputs have ended (Ctrl-C) closes its files as they are: valid, with
/// what was known. Adds all writers to a graph, after the stages that feed them.
void addWriters(LocalGraph& graph, const WriterParams& params, const std::string& out);

class TrajectoryWriterStage : public Stage {
 public:
  enum Input : std::size_t { kAnchor, kOdometry };
  explicit TrajectoryWriterStage(const std::filesystem::path& out);
  ~TrajectoryWriterStage() override;
  void push(const Anchor& anchor);
  void push(const Odometry& odometry);

 private:
  void onEnd() override { writer_.close(); }
  TrajectoryWriter writer_;
};

class CloudWriterStage : public Stage {
 public:
  CloudWriterStage(const CloudWriterParams& params, const std::filesystem::path& out);
  void push(std::size_t lidar, const BatchedSweepPtr& batched);

 private:
  CloudWriterParams params_;
  CloudWriter writer_;
  std::vector<std::uint32_t> count_;
};

class DepthWriterStage : public Stage {
 public:
  DepthWriterStage(const DepthWriterParams& params, const std::filesystem::path& out);
  void push(std::size_t camera, const DepthImagePtr& depth);

 private:
  DepthWriterParams params_;
  DepthWriter writer_;
  std::vector<std::uint32_t> count_;
};

class FrustumWriterStage : public Stage {
 public:
  FrustumWriterStage(const FrustumWriterParams& params, const std::filesystem::path& out);
  ~FrustumWriterStage() override;
  void push(std::size_t camera, const Frustums& frustums);

 private:
  void onEnd() override { writer_.close(); }
  FrustumWriter writer_;
};

class ThermalWriterStage : public Stage {
 public:
  enum Input : std::size_t { kTemperature, kImage, kInfo, kProjected };
  ThermalWriterStage(const ThermalWriterParams& params, const std::filesystem::path& out);
  ~ThermalWriterStage() override;
  void push(const TemperatureRange& range);
  void push(const ImagePtr& image);
  void push(const CameraInfo& info);
  void push(const ProjectedDetections& projected);

 private:
  void onEnd() override;
  ThermalWriter writer_;
};

class ObstacleWriterStage : public Stage {
 public:
  explicit ObstacleWriterStage(const std::filesystem::path& out);
  ~ObstacleWriterStage() override;
  void push(const Obstacles& obstacles);

 private:
  void onEnd() override { writer_.close(); }
  ObstacleWriter writer_;
};

class LineWriterStage : public Stage {
 public:
  LineWriterStage(const LineWriterParams& params, const std::filesystem::path& out);
  ~LineWriterStage() override;
  void push(std::size_t lidar, const Lines& lines);

 private:
  void onEnd() override { writer_.close(); }
  LineWriterParams params_;
  LineWriter writer_;
};

class ObjectWriterStage : public Stage {
 public:
  explicit ObjectWriterStage(const std::filesystem::path& out);
  ~ObjectWriterStage() override;
  void push(const ObjectsPtr& objects);

 private:
  void onEnd() override { writer_.close(); }
  ObjectWriter writer_;
};

template <class Bus>
StageFactory bindTrajectoryWriter(Bus& bus, const std::string& out) {
  using S = TrajectoryWriterStage;
  bus.template input<S, Anchor>(S::kAnchor, "anchor", [](S& s, const Anchor& a) { s.push(a); });
  bus.template input<S, Odometry>(S::kOdometry, "odometry", [](S& s, const Odometry& o) { s.push(o); });
  return [=] { return std::make_unique<S>(out); };
}
template <class Bus>
StageFactory bindCloudWriter(Bus& bus, const CloudWriterParams& params, const std::string& out) {
  inputs<CloudWriterStage, BatchedSweepPtr>(bus, 0, params.lidars, "/batches");
  return [=] { return std::make_unique<CloudWriterStage>(params, out); };
}
template <class Bus>
void bindMapColours(Bus& bus, const MapWriterParams& params) {
  using S = MapWriterStage;
  const auto at = [&params](S::ColourInput input, std::size_t c = 0) {
    return S::colourInput(params, input, c);
  };
  bus.template input<S, StaticTransforms>(at(S::kTfStatic), "tf_static",
                                          [](S& s, const StaticTransforms& t) { s.push(kStaticStamp, t); });
  bus.template input<S, Odometry>(at(S::kOdometry), "odometry", [](S& s, const Odometry& o) { s.push(o); });
  for (std::size_t c = 0; c < params.colour_cameras.size(); ++c) {
    const std::string& camera = params.colour_cameras[c];
    bus.template input<S, CameraInfo>(at(S::kInfo, c), camera + "/camera_info",
                                      [c](S& s, const CameraInfo& info) { s.push(c, info); });
    bus.template input<S, ImagePtr>(at(S::kPicture, c), camera + "/image",
                                    [c](S& s, const ImagePtr& picture) { s.push(c, picture); });
    bus.template input<S, DepthImagePtr>(at(S::kDepth, c), camera + "/depth/image",
                                         [c](S& s, const DepthImagePtr& depth) { s.pushDepth(c, depth); });
    bus.template input<S, DepthImagePtr>(at(S::kConfidence, c), camera + "/depth/confidence",
                                         [c](S& s, const DepthImagePtr& d) { s.pushConfidence(c, d); });
  }
}
template <class Bus>
StageFactory bindMapWriter(Bus& bus, const MapWriterParams& params, const std::string& out) {
  using S = MapWriterStage;
  validate(params);
  bus.template input<S, Anchor>(S::kAnchor, "anchor", [](S& s, const Anchor& a) { s.push(a); });
  inputs<S, BatchedSweepPtr>(bus, S::kFirstLidar, params.lidars, "/batches");
  if (params.map.colour) bindMapColours(bus, params);
  return [=] { return std::make_unique<S>(params, out); };
}
template <class Bus>
StageFactory bindDepthWriter(Bus& bus, const DepthWriterParams& params, const std::string& out) {
  inputs<DepthWriterStage, DepthImagePtr>(bus, 0, params.cameras, "/depth/image");
  return [=] { return std::make_unique<DepthWriterStage>(params, out); };
}
template <class Bus>
StageFactory bindFrustumWriter(Bus& bus, const FrustumWriterParams& params, const std::string& out) {
  inputs<FrustumWriterStage, Frustums>(bus, 0, params.cameras, "/frustums");
  return [=] { return std::make_unique<FrustumWriterStage>(params, out); };
}
template <class Bus>
StageFactory bindThermalWriter(Bus& bus, const ThermalWriterParams& params, const std::string& out) {
  using S = ThermalWriterStage;
  validate(params.dataset);
  const std::string& camera = params.thermal_camera;
  bus.template input<S, TemperatureRange>(S::kTemperature, camera + "/temperature_range",
                                          [](S& s, const TemperatureRange& range) { s.push(range); });
  bus.template input<S, ImagePtr>(S::kImage, camera + "/image",
                                  [](S& s, const ImagePtr& image) { s.push(image); });
  bus.template input<S, CameraInfo>(S::kInfo, camera + "/camera_info",
                                    [](S& s, const CameraInfo& info) { s.push(info); });
  bus.template input<S, ProjectedDetections>(S::kProjected, camera + "/projected_detections",
                                             [](S& s, const ProjectedDetections& p) { s.push(p); });
  return [=] { return std::make_unique<S>(params, out); };
}
template <class Bus>
StageFactory bindObstacleWriter(Bus& bus, const std::string& out) {
  using S = ObstacleWriterStage;
  bus.template input<S, Obstacles>(0, "obstacles", [](S& s, const Obstacles& o) { s.push(o); });
  return [=] { return std::make_unique<S>(out); };
}
template <class Bus>
StageFactory bindLineWriter(Bus& bus, const LineWriterParams& params, const std::string& out) {
  inputs<LineWriterStage, Lines>(bus, 0, params.lidars, "/lines");
  return [=] { return std::make_unique<LineWriterStage>(params, out); };
}
template <class Bus>
StageFactory bindStatusWriter(Bus& bus, const std::string& out) {
  using S = StatusWriterStage;
  bus.template input<S, SensorStatus>(0, "sensor_status",
                                      [](S& s, const SensorStatus& status) { s.push(status); });
  return [=] { return std::make_unique<S>(out); };
}
template <class Bus>
StageFactory bindObjectWriter(Bus& bus, const std::string& out) {
  using S = ObjectWriterStage;
  bus.template input<S, ObjectsPtr>(0, "objects", [](S& s, const ObjectsPtr& o) { s.push(o); });
  return [=] { return std::make_unique<S>(out); };
}
template <class Bus>
StageFactory bindTraceWriter(Bus& bus, const std::string& out) {
  using S = TraceWriterStage;
  inputs<S, ProductOrigins>(bus, 0, {"camera_lidar", "thermal", "depth"}, "/origins");
  bus.template input<S, ObjectsPtr>(S::kObjects, "objects", [](S& s, const ObjectsPtr& o) { s.push(o); });
  return [=] { return std::make_unique<TraceWriterStage>(out); };
}
template <class Bus>
StageFactory bindOverlayWriter(Bus& bus, const OverlayWriterParams& params, const std::string& out) {
  using S = OverlayWriterStage;
  validate(params);
  for (std::size_t c = 0; c < params.cameras.size(); ++c) {
    const std::string& camera = params.cameras[c];
    bus.template input<S, ImagePtr>(S::input(c, S::kImage), camera + "/image",
                                    [c](S& s, const ImagePtr& image) { s.push(c, image); });
    bus.template input<S, DepthImagePtr>(S::input(c, S::kDepth), camera + "/depth/image",
                                         [c](S& s, const DepthImagePtr& depth) { s.push(c, depth); });
    bus.template input<S, Frustums>(S::input(c, S::kFrustums), camera + "/frustums",
                                    [c](S& s, const Frustums& frustums) { s.push(c, frustums); });
  }
  const auto overlays = outputs<ImagePtr>(bus, params.cameras, "/overlay/image");
  return [=] {
    auto stage = std::make_unique<S>(params, out);
    stage->on_overlay = overlays;
    return stage;
  };
}

}  // namespace atlas
