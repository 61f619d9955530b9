// SPDX-License-Identifier: MIT
#include "overlay_writer.hpp"

#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "atlas/output/overlay.hpp"
#include "files/png_file.hpp"

namespace atlas {
namespace {

std::vector<std::string> inputNames(const std::vector<std::string>& cameras) {
  std::vector<std::string> names;
  for (const std::string& camera : cameras) {
    for (const char* part : {"/image", "/depth/image", "/frustums"}) names.push_back(camera + part);
  }
  return names;
}

}  // namespace

void validate(const OverlayWriterParams& params) {
  if (!(params.period_s > 0)) {
    throw std::invalid_argument("overlay_writer: period_s must be positive, got " +
                                std::to_string(params.period_s));
  }
  if (params.cameras.empty()) throw std::invalid_argument("overlay_writer: cameras is empty");
}

OverlayWriterStage::OverlayWriterStage(const OverlayWriterParams& params, std::filesystem::path out)
    : Stage("overlay_writer", inputNames(params.cameras)),
      params_(params),
      out_(std::move(out)),
      image_count_(params.cameras.size(), 0),
      last_period_(params.cameras.size(), -1),
      waiting_(params.cameras.size()) {
  validate(params);
}

void OverlayWriterStage::push(std::size_t camera, const ImagePtr& image) {
  const std::uint32_t index = image_count_.at(camera)++;
  enqueue(input(camera, kImage), image->stamp, [this, camera, image, index] {
    const std::int64_t period = image->stamp / fromSeconds(params_.period_s);
    if (period == last_period_[camera]) return;
    last_period_[camera] = period;
    Picture& picture =
        waiting_[camera][image->stamp];  // dispatched before depth and frustums of the same stamp
    picture.index = index;
    picture.image = image;
  });
}

void OverlayWriterStage::push(std::size_t camera, const DepthImagePtr& depth) {
  enqueue(input(camera, kDepth), depth->stamp, [this, camera, depth] {
    const auto it = waiting_[camera].find(depth->stamp);
    if (it != waiting_[camera].end()) it->second.depth = depth;
  });
}

void OverlayWriterStage::push(std::size_t camera, const Frustums& frustums) {
  enqueue(input(camera, kFrustums), frustums.stamp, [this, camera, frustums] {
    const auto it = waiting_[camera].find(frustums.stamp);
    if (it != waiting_[camera].end()) it->second.frustums = frustums;
  });
}

void OverlayWriterStage::onProgress() {
  const Stamp reached = merge().watermark();
  for (std::size_t camera = 0; camera < waiting_.size(); ++camera) {
    auto& waiting = waiting_[camera];
    while (!waiting.empty() && waiting.begin()->first <= reached) {
      const Picture picture = std::move(waiting.begin()->second);
      waiting.erase(waiting.begin());
      write(camera, picture);
    }
  }
}

void OverlayWriterStage::write(std::size_t camera, const Picture& picture) {
  cv::Mat canvas = picture.image->pixels.clone();
  if (canvas.empty()) return counters_.skip("overlay", Reason::kEmpty);
  if (canvas.type() != CV_8UC1 && canvas.type() != CV_8UC3)
    return counters_.skip("overlay", Reason::kBadLayout);
  if (canvas.channels() == 1) cv::cvtColor(canvas, canvas, cv::COLOR_GRAY2BGR);
  if (picture.depth && picture.depth->depth.size() == canvas.size()) {
    canvas = drawDepth(canvas, picture.depth->depth);
  } else if (picture.depth && !picture.depth->depth.empty()) {
    counters_.skip("depth of an overlay",
                   Reason::kBadLayout);  // the image has another size than its camera_info
  }
  if (picture.frustums) canvas = drawFrustums(canvas, *picture.frustums);
  char name[32];
  std::snprintf(name, sizeof name, "%06u.png", picture.index);
  writePng(out_ / "overlay" / params_.cameras[camera] / name, canvas);
  counters_.add("overlays");
  if (!on_overlay) return;
  auto overlay = std::make_shared<Image>();
  overlay->stamp = picture.image->stamp;
  overlay->frame = picture.image->frame;
  overlay->format = "bgr8";
  overlay->pixels = canvas;
  on_overlay(camera, overlay);
}

}  // namespace atlas
