// SPDX-License-Identifier: MIT
#include "files/map_writer_stage.hpp"

#include <cstdio>
#include <stdexcept>

namespace atlas {
namespace {

std::vector<std::string> inputNames(const MapWriterParams& params) {
  validate(params);
  std::vector<std::string> names = {"anchor"};
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  if (!params.map.colour) return names;
  names.insert(names.end(), {"tf_static", "odometry"});
  for (const std::string& camera : params.colour_cameras) {
    for (const char* part : {"/camera_info", "/image", "/depth/image", "/depth/confidence"})
      names.push_back(camera + part);
  }
  return names;
}

}  // namespace

void validate(const MapWriterParams& params) {
  validate(params.map);
  if (params.map.colour && params.colour_cameras.empty())
    throw std::invalid_argument("map_writer: colour needs colour_cameras, got none");
}

MapWriterStage::MapWriterStage(const MapWriterParams& params, const std::filesystem::path& out)
    : Stage("map_writer", inputNames(params)),
      params_(params),
      writer_(out, params.map),
      colours_(params.colour_cameras.size(), counters_) {}

MapWriterStage::~MapWriterStage() {
  try {
    finishOnce();
  } catch (const std::exception& error) {  // nothing may leave a destructor
    std::fprintf(stderr, "map_writer: %s\n", error.what());
  }
}

void MapWriterStage::push(const Anchor& anchor) {
  enqueue(kAnchor, anchor.stamp, [this, anchor] { anchor_ = anchor; });
}
void MapWriterStage::push(std::size_t lidar, const BatchedSweepPtr& batched) {
  enqueue(kFirstLidar + lidar, batched->stamp, [this, batched] {
    if (batched->batches.empty()) {
      counters_.skip("sweep", Reason::kNoPoseYet);
      return;
    }
    writer_.add(*batched);
    counters_.add("sweeps");
  });
}
void MapWriterStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(colourInput(params_, kTfStatic), stamp, [this, transforms] { colours_.add(transforms); });
}
void MapWriterStage::push(const Odometry& odometry) {
  enqueue(colourInput(params_, kOdometry), odometry.stamp, [this, odometry] { colours_.add(odometry); });
}
void MapWriterStage::push(std::size_t camera, const CameraInfo& info) {
  enqueue(colourInput(params_, kInfo, camera), info.stamp,
          [this, camera, info] { colours_.add(camera, info); });
}
void MapWriterStage::push(std::size_t camera, const ImagePtr& picture) {
  enqueue(colourInput(params_, kPicture, camera), picture->stamp,
          [this, camera, picture] { colours_.add(camera, picture); });
}
void MapWriterStage::pushDepth(std::size_t camera, const DepthImagePtr& depth) {
  enqueue(colourInput(params_, kDepth, camera), depth->stamp,
          [this, camera, depth] { colours_.addDepth(camera, depth); });
}
void MapWriterStage::pushConfidence(std::size_t camera, const DepthImagePtr& confidence) {
  enqueue(colourInput(params_, kConfidence, camera), confidence->stamp,
          [this, camera, confidence] { colours_.addConfidence(camera, confidence); });
}

void MapWriterStage::colour(Stamp merged) {
  colours_.answer(merged, [this](const std::vector<ColouredPoint>& seen) { writer_.add(seen); });
}

void MapWriterStage::onEnd() {
  colour(kEndOfTime);
  if (!anchor_) counters_.skip("map", Reason::kNoPoseYet);
  finishOnce();
}

void MapWriterStage::finishOnce() {
  if (finished_ || !anchor_) return;
  finished_ = true;
  writer_.finish(*anchor_);
}

}  // namespace atlas
