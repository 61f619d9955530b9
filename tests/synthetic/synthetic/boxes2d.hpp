// SPDX-License-Identifier: MIT
// Exact boxes of the visible objects of a picture, and what an image detector would make of them.
#pragma once

#include <vector>

#include "synthetic/camera_view.hpp"
#include "synthetic/options.hpp"
#include "synthetic/random.hpp"
#include "synthetic/truth.hpp"

namespace atlas::synthetic {

/// Objects with at least 4 visible pixels, by id. Stamp and frame are the caller's.
std::vector<TruthBox2d> visibleBoxes(const View& view, const CameraView& camera, const Scene& scene);

struct FakeDetection {
  double x1, y1, x2, y2;  ///< px
  double confidence;
  int class_id;
};
/// Boxes with noise; none for objects that are hidden by more than 70 %, smaller than 8 px, or missed. A
/// cyclist gives a bicycle and a person.
std::vector<FakeDetection> detect(const std::vector<TruthBox2d>& boxes, const Camera& camera,
                                  const NoiseOptions& noise, Random& random);

}  // namespace atlas::synthetic
