// SPDX-License-Identifier: MIT
#include "files/writer_stages.hpp"

#include <cstdio>

namespace atlas {
namespace {

std::vector<std::string> withSuffix(const std::vector<std::string>& names, const std::string& suffix) {
  std::vector<std::string> result;
  for (const std::string& name : names) result.push_back(name + suffix);
  return result;
}

/// For destructors: what cannot be written any more is said nowhere else, and nothing may leave a destructor.
template <class Close>
void closeQuietly(const char* what, Close&& close) {
  try {
    close();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", what, error.what());
  }
}

}  // namespace

void addWriters(LocalGraph& graph, const WriterParams& params, const std::string& out) {
  using Bus = LocalGraph::Bus;
  graph.beginThread();
  graph.add([&](Bus& bus) { return bindTrajectoryWriter(bus, out); });
  graph.add([&](Bus& bus) { return bindMapWriter(bus, params.map, out); });
  graph.add([&](Bus& bus) { return bindDepthWriter(bus, params.depth, out); });
  graph.add([&](Bus& bus) { return bindFrustumWriter(bus, params.frustum, out); });
  graph.add([&](Bus& bus) { return bindThermalWriter(bus, params.thermal, out); });
  graph.add([&](Bus& bus) { return bindGridWriter(bus, params.grid, out); });
  graph.add([&](Bus& bus) { return bindObstacleWriter(bus, out); });
  graph.add([&](Bus& bus) { return bindObjectWriter(bus, out); });
  graph.add([&](Bus& bus) { return bindStatusWriter(bus, out); });
  graph.add([&](Bus& bus) { return bindTraceWriter(bus, out); });
  graph.add([&](Bus& bus) { return bindOverlayWriter(bus, params.overlay, out); });
  if (params.write_lines) graph.add([&](Bus& bus) { return bindLineWriter(bus, params.line, out); });
  if (params.write_deskewed) graph.add([&](Bus& bus) { return bindCloudWriter(bus, params.cloud, out); });
}

TrajectoryWriterStage::TrajectoryWriterStage(const std::filesystem::path& out)
    : Stage("trajectory_writer", {"anchor", "odometry"}), writer_(out) {}
TrajectoryWriterStage::~TrajectoryWriterStage() {
  closeQuietly("trajectory_writer", [this] { writer_.close(); });
}
void TrajectoryWriterStage::push(const Anchor& anchor) {
  enqueue(kAnchor, anchor.stamp, [this, anchor] { writer_.writeAnchor(anchor); });
}
void TrajectoryWriterStage::push(const Odometry& odometry) {
  enqueue(kOdometry, odometry.stamp, [this, odometry] {
    writer_.write(odometry);
    counters_.add("poses");
  });
}

CloudWriterStage::CloudWriterStage(const CloudWriterParams& params, const std::filesystem::path& out)
    : Stage("cloud_writer", withSuffix(params.lidars, "/batches")),
      params_(params),
      writer_(out),
      count_(params.lidars.size(), 0) {}
void CloudWriterStage::push(std::size_t lidar, const BatchedSweepPtr& batched) {
  const std::uint32_t index = count_.at(lidar)++;
  enqueue(lidar, batched->stamp, [this, lidar, batched, index] {
    if (batched->batches.empty()) {
      counters_.skip("sweep", Reason::kNoPoseYet);
      return;
    }
    writer_.write(params_.lidars[lidar], index, *batched);
    counters_.add("sweeps");
  });
}

DepthWriterStage::DepthWriterStage(const DepthWriterParams& params, const std::filesystem::path& out)
    : Stage("depth_writer", withSuffix(params.cameras, "/depth/image")),
      params_(params),
      writer_(out, params.preview_period),
      count_(params.cameras.size(), 0) {}
void DepthWriterStage::push(std::size_t camera, const DepthImagePtr& depth) {
  const std::uint32_t index = count_.at(camera)++;
  enqueue(camera, depth->stamp, [this, camera, depth, index] {
    if (depth->depth.empty()) {
      counters_.skip("depth image", Reason::kMissingIntrinsics);
      return;
    }
    writer_.write(params_.cameras[camera], index, depth->depth);
    counters_.add("depth images");
  });
}

FrustumWriterStage::FrustumWriterStage(const FrustumWriterParams& params, const std::filesystem::path& out)
    : Stage("frustum_writer", withSuffix(params.cameras, "/frustums")), writer_(out) {}
FrustumWriterStage::~FrustumWriterStage() {
  closeQuietly("frustum_writer", [this] { writer_.close(); });
}
void FrustumWriterStage::push(std::size_t camera, const Frustums& frustums) {
  enqueue(camera, frustums.stamp, [this, frustums] {
    writer_.write(frustums);
    counters_.add("frustums", frustums.frustums.size());
  });
}

ThermalWriterStage::ThermalWriterStage(const ThermalWriterParams& params, const std::filesystem::path& out)
    : Stage("thermal_writer", {"temperature_range", "image", "camera_info", "projected_detections"}),
      writer_(params.dataset, out) {}
ThermalWriterStage::~ThermalWriterStage() {
  closeQuietly("thermal_writer", [this] { writer_.close(); });
}
void ThermalWriterStage::push(const TemperatureRange& range) {
  enqueue(kTemperature, range.stamp, [this, range] { writer_.add(range); });
}
void ThermalWriterStage::push(const ImagePtr& image) {
  enqueue(kImage, image->stamp, [this, image] { writer_.add(image); });
}
void ThermalWriterStage::push(const CameraInfo& info) {
  enqueue(kInfo, info.stamp, [this, info] { writer_.add(info); });
}
void ThermalWriterStage::push(const ProjectedDetections& projected) {
  enqueue(kProjected, projected.detections.stamp, [this, projected] {
    writer_.add(projected);
    counters_.add("projected detections", projected.detections.boxes.size());
  });
}

void ThermalWriterStage::onEnd() {
  writer_.close();
  counters_.add("frames", writer_.frames());
  for (const auto& [what, count] : writer_.dropped()) counters_.add("skipped " + what, count);
}

ObjectWriterStage::ObjectWriterStage(const std::filesystem::path& out)
    : Stage("object_writer", {"objects"}), writer_(out) {}
ObjectWriterStage::~ObjectWriterStage() {
  closeQuietly("object_writer", [this] { writer_.close(); });
}
void ObjectWriterStage::push(const ObjectsPtr& objects) {
  enqueue(0, objects->stamp, [this, objects] {
    writer_.write(*objects);
    counters_.add("objects", objects->objects.size());
  });
}

ObstacleWriterStage::ObstacleWriterStage(const std::filesystem::path& out)
    : Stage("obstacle_writer", {"obstacles"}), writer_(out) {}
ObstacleWriterStage::~ObstacleWriterStage() {
  closeQuietly("obstacle_writer", [this] { writer_.close(); });
}
void ObstacleWriterStage::push(const Obstacles& obstacles) {
  enqueue(0, obstacles.stamp, [this, obstacles] {
    writer_.write(obstacles);
    counters_.add("obstacles", obstacles.obstacles.size());
  });
}

LineWriterStage::LineWriterStage(const LineWriterParams& params, const std::filesystem::path& out)
    : Stage("line_writer", withSuffix(params.lidars, "/lines")), params_(params), writer_(out) {}
LineWriterStage::~LineWriterStage() {
  closeQuietly("line_writer", [this] { writer_.close(); });
}
void LineWriterStage::push(std::size_t lidar, const Lines& lines) {
  enqueue(lidar, lines.stamp, [this, lidar, lines] {
    writer_.write(params_.lidars[lidar], lines);
    counters_.add("lines", lines.lines.size());
  });
}

}  // namespace atlas
