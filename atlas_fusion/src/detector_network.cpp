// SPDX-License-Identifier: MIT
#include "detector_network.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/dnn.hpp>
#include <stdexcept>

#include "atlas/output/coco_names.hpp"

namespace atlas_fusion {

atlas::Network loadNetwork(const atlas::DetectorParams& params) {
  const std::string what = "detector: model " + params.model + ": ";
  if (!std::filesystem::is_regular_file(params.model)) throw std::invalid_argument(what + "no such file");
  cv::setNumThreads(1);
  auto net = std::make_shared<cv::dnn::Net>();
  try {
    *net = cv::dnn::readNetFromONNX(params.model);
    net->setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net->setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  } catch (const cv::Exception& error) {
    throw std::invalid_argument(what + "not an ONNX model that OpenCV can run: " + error.err);
  }
  const atlas::Network network = [net](const cv::Mat& input) {
    net->setInput(input);
    return net->forward().clone();  // the net writes its next output to the same place
  };
  try {
    const cv::Mat grey(params.input_px, params.input_px, CV_8UC3, cv::Scalar::all(114));
    atlas::detectionsOf(network(atlas::networkInput(grey, params.input_px)), grey.size(), params.input_px,
                        params.limits, params.classes);
  } catch (const cv::Exception& error) {
    throw std::invalid_argument(what + "does not take an input of 1 x 3 x " +
                                std::to_string(params.input_px) + " x " + std::to_string(params.input_px) +
                                " (input_px): " + error.err);
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(what + error.what());
  }
  return network;
}

std::vector<int> classIds(const std::vector<std::string>& names) {
  const std::vector<std::string>& known = atlas::cocoNames();
  std::vector<int> ids;
  for (const std::string& name : names) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end())
      throw std::invalid_argument("detector: class_names: '" + name + "' is not in COCO-80");
    ids.push_back(static_cast<int>(at - known.begin()));
  }
  return ids;
}

}  // namespace atlas_fusion
