// SPDX-License-Identifier: MIT
// Stage: images become detections, by a network that the user brings. For records that carry no detections.
// The network itself stands behind a function, so that the core needs no inference library.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "atlas/base/local_graph.hpp"
#include "atlas/base/stage.hpp"
#include "atlas/camera/detector_output.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct DetectorParams {
  std::string model;                 ///< path of an ONNX file
  std::vector<std::string> cameras;  ///< topic prefixes
  int input_px = 640;                ///< side of the network's square input
  int classes = 0;                   ///< of the model; 0 = as the shape of its output says
  std::vector<int> class_ids;        ///< COCO-80 number of each class of the model; empty = it has those
  DetectionLimits limits;
};
/// Throws std::invalid_argument naming the parameter.
void validate(const DetectorParams& params);

/// Output of the network for its input (see networkInput). The same input must give the same output.
using Network = std::function<cv::Mat(const cv::Mat&)>;

class DetectorStage : public Stage {
 public:
  DetectorStage(const DetectorParams& params, Network network);

  void push(std::size_t camera, const ImagePtr& image);

  /// One for every image, empty when there is nothing to see or nothing to look at.
  std::function<void(std::size_t camera, const Detections&)> on_detections;

 private:
  void answer(std::size_t camera, const Image& image);
  [[nodiscard]] std::vector<Detection2d> look(const cv::Mat& pixels);

  DetectorParams params_;
  Network network_;
  std::vector<std::uint32_t> image_count_;
};

/// Output `<camera>/detections` of `<camera>/image`: a recording with that topic cannot be played beside it.
template <class Bus>
StageFactory bindDetector(Bus& bus, const DetectorParams& params, const Network& network) {
  validate(params);
  std::vector<std::function<void(const Detections&)>> emits;
  for (std::size_t c = 0; c < params.cameras.size(); ++c) {
    bus.template input<DetectorStage, ImagePtr>(
        c, params.cameras[c] + "/image", [c](DetectorStage& s, const ImagePtr& image) { s.push(c, image); });
    emits.push_back(bus.template output<Detections>(params.cameras[c] + "/detections"));
  }
  return [=] {
    auto stage = std::make_unique<DetectorStage>(params, network);
    stage->on_detections = [emits](std::size_t camera, const Detections& d) { emits.at(camera)(d); };
    return stage;
  };
}

}  // namespace atlas
