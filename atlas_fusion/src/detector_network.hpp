// SPDX-License-Identifier: MIT
// An ONNX model run by OpenCV, on the processor.
#pragma once

#include "atlas/camera/detector_stage.hpp"

namespace atlas_fusion {

/// Reads params.model and runs it once, so that a model that cannot be used is refused before the run begins:
/// throws std::invalid_argument with the path and what is wrong. One thread per image: the sums of a network
/// are then always added in the same order.
atlas::Network loadNetwork(const atlas::DetectorParams& params);

/// Numbers of these classes in COCO-80; throws std::invalid_argument naming the one that is not among them.
std::vector<int> classIds(const std::vector<std::string>& names);

}  // namespace atlas_fusion
