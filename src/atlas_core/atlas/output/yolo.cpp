// SPDX-License-Identifier: MIT
#include "atlas/output/yolo.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/output/fixed_text.hpp"

namespace atlas {

std::optional<NormalizedBox> normalized(const Detection2d& box, int image_width, int image_height) {
  for (const double edge : {box.x_min, box.y_min, box.x_max, box.y_max}) {
    if (!std::isfinite(edge)) return std::nullopt;
  }
  const double left = std::max(box.x_min, 0.0) / image_width;
  const double right = std::min(box.x_max, static_cast<double>(image_width)) / image_width;
  const double top = std::max(box.y_min, 0.0) / image_height;
  const double bottom = std::min(box.y_max, static_cast<double>(image_height)) / image_height;
  if (!(left < right) || !(top < bottom)) return std::nullopt;
  return NormalizedBox{0.5 * (left + right), 0.5 * (top + bottom), right - left, bottom - top};
}

std::string yoloLabels(const Detections& detections, int image_width, int image_height) {
  std::string text;
  for (const Detection2d& detection : detections.boxes) {
    const auto box = normalized(detection, image_width, image_height);
    if (!box) continue;
    text += std::to_string(detection.class_id);
    for (const double share : {box->center_x, box->center_y, box->width, box->height})
      text += " " + fixedText(share, 6);
    text += "\n";
  }
  return text;
}

}  // namespace atlas
