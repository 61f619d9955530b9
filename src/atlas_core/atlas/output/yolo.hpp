// SPDX-License-Identifier: MIT
// YOLO labels: one line `class cx cy w h` per box, x and w divided by the image's width, y and h by its
// height, all in [0, 1]. Boxes are in pixels whose centres are whole numbers, so the left edge of the image
// is -1/2 and its right edge width - 1/2: a share is (u + 1/2) / width.
#pragma once

#include <optional>
#include <string>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// A box as shares of the image.
struct NormalizedBox {
  double center_x = 0, center_y = 0, width = 0, height = 0;
};

/// The part of the box inside the image; nullopt when nothing is, or the box is not finite.
std::optional<NormalizedBox> normalized(const Detection2d& box, int image_width, int image_height);

/// All boxes of an image, one line each, 6 decimals; boxes outside the image are left out. Empty text when
/// there are none.
std::string yoloLabels(const Detections& detections, int image_width, int image_height);

}  // namespace atlas
