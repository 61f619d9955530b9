// SPDX-License-Identifier: MIT
#include "atlas/camera/detector_stage.hpp"

#include <stdexcept>
#include <utility>

namespace atlas {
namespace {

std::vector<std::string> inputNames(const std::vector<std::string>& cameras) {
  std::vector<std::string> names;
  for (const std::string& camera : cameras) names.push_back(camera + "/image");
  return names;
}

}  // namespace

void validate(const DetectorParams& params) {
  if (params.model.empty()) throw std::invalid_argument("detector: model is empty: the path of an ONNX file");
  if (params.cameras.empty()) throw std::invalid_argument("detector: cameras is empty");
  if (params.input_px < 32 || params.input_px > 4096) {
    throw std::invalid_argument("detector: input_px must be 32 to 4096, got " +
                                std::to_string(params.input_px));
  }
  if (params.classes < 0)
    throw std::invalid_argument("detector: classes must not be negative, got " +
                                std::to_string(params.classes));
  for (const int id : params.class_ids) {
    if (id < 0 || id > 79)
      throw std::invalid_argument("detector: class_ids must be 0 to 79, got " + std::to_string(id));
  }
  try {
    validate(params.limits);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("detector: ") + error.what());
  }
}

DetectorStage::DetectorStage(const DetectorParams& params, Network network)
    : Stage("detector", inputNames(params.cameras)),
      params_(params),
      network_(std::move(network)),
      image_count_(params.cameras.size(), 0) {
  validate(params);
}

void DetectorStage::push(std::size_t camera, const ImagePtr& image) {
  enqueue(camera, image->stamp, [this, camera, image] { answer(camera, *image); });
}

void DetectorStage::answer(std::size_t camera, const Image& image) {
  Detections detections;
  detections.stamp = image.stamp;
  detections.frame = image.frame;
  detections.image_index = image_count_[camera]++;
  const cv::Mat& pixels = image.pixels;
  if (pixels.empty()) {
    counters_.skip("image", Reason::kEmpty);
  } else if (pixels.type() != CV_8UC1 && pixels.type() != CV_8UC3) {
    counters_.skip("image", Reason::kBadLayout);
  } else {
    detections.boxes = look(pixels);
    counters_.add("images");
    counters_.add("detections", detections.boxes.size());
  }
  if (on_detections) on_detections(camera, detections);
}

std::vector<Detection2d> DetectorStage::look(const cv::Mat& pixels) {
  std::vector<Detection2d> boxes =
      detectionsOf(network_(networkInput(pixels, params_.input_px)), pixels.size(), params_.input_px,
                   params_.limits, params_.classes);
  if (params_.class_ids.empty()) return boxes;
  for (Detection2d& box : boxes) {
    if (static_cast<std::size_t>(box.class_id) >= params_.class_ids.size()) {
      throw std::runtime_error("detector: class " + std::to_string(box.class_id) +
                               " of the model has no number in class_ids");
    }
    box.class_id = params_.class_ids[static_cast<std::size_t>(box.class_id)];
  }
  return boxes;
}

}  // namespace atlas
