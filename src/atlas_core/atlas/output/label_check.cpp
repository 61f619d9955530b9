// SPDX-License-Identifier: MIT
#include "atlas/output/label_check.hpp"

#include <cmath>

#include "atlas/output/coco_names.hpp"
#include "atlas/output/yolo.hpp"

namespace atlas {

const char* whyNoLabel(const Detection2d& detection, int image_width, int image_height) {
  for (const double value :
       {detection.x_min, detection.y_min, detection.x_max, detection.y_max, detection.confidence}) {
    if (!std::isfinite(value)) return "not finite";
  }
  const auto classes = static_cast<std::int32_t>(cocoNames().size());
  if (detection.class_id < 0 || detection.class_id >= classes) return "unknown class id";
  return normalized(detection, image_width, image_height) ? nullptr : "outside the image";
}

}  // namespace atlas
