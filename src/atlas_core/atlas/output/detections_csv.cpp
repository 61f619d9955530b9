// SPDX-License-Identifier: MIT
#include "atlas/output/detections_csv.hpp"

#include "atlas/output/fixed_text.hpp"
#include "atlas/output/yolo.hpp"

namespace atlas {

std::string detectionRows(const Detections& detections, int image_width, int image_height) {
  std::string text;
  for (const Detection2d& detection : detections.boxes) {
    const auto box = normalized(detection, image_width, image_height);
    if (!box) continue;
    text += std::to_string(detections.image_index);
    for (const double value : {box->center_x, box->center_y, box->width, box->height, detection.confidence}) {
      text += ", " + fixedText(value, 6);
    }
    text += ", " + std::to_string(detection.class_id) + "\n";
  }
  return text;
}

}  // namespace atlas
