// SPDX-License-Identifier: MIT
// The format of the RGB detections of the Brno Urban Dataset since 2021: rows `frame, cx, cy, w, h, conf,
// class`, the box centre and size as shares of the image.
#pragma once

#include <string>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// One row per box of an image, 6 decimals; boxes outside the image are left out.
std::string detectionRows(const Detections& detections, int image_width, int image_height);

}  // namespace atlas
