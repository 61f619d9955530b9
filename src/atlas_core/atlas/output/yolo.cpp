// SPDX-License-Identifier: MIT
#include "atlas/output/yolo.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/output/fixed_text.hpp"

namespace atlas {
namespace {

/// Of the image's edge: 0 at the outer edge of the first pixel, 1 at that of the last.
double share(double pixel, int size) { return std::clamp((pixel + 0.5) / size, 0.0, 1.0); }

}  // namespace

std::optional<NormalizedBox> normalized(const Detection2d& box, int image_width, int image_height) {
  for (const double edge : {box.x_min, box.y_min, box.x_max, box.y_max}) {
    if (!std::isfinite(edge)) return std::nullopt;
  }
  const double left = share(box.x_min, image_width), right = share(box.x_max, image_width);
  const double top = share(box.y_min, image_height), bottom = share(box.y_max, image_height);
  if (!(left < right) || !(top < bottom)) return std::nullopt;
  return NormalizedBox{0.5 * (left + right), 0.5 * (top + bottom), right - left, bottom - top};
}

std::string yoloLabels(const Detections& detections, int image_width, int image_height) {
  std::string text;
  for (const Detection2d& detection : detections.boxes) {
    const auto box = normalized(detection, image_width, image_height);
    if (!box) continue;
    text += std::to_string(detection.class_id);
    for (const double value : {box->center_x, box->center_y, box->width, box->height})
      text += " " + fixedText(value, 6);
    text += "\n";
  }
  return text;
}

}  // namespace atlas
