// SPDX-License-Identifier: MIT
// Which detections can be labels of an image: one rule for every format that a dataset is written in.
#pragma once

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// nullptr when the detection is a label; else why not: "not finite", "unknown class id" (no name in
/// cocoNames(), so that a file would refer to a category it does not have), "outside the image".
const char* whyNoLabel(const Detection2d& detection, int image_width, int image_height);

}  // namespace atlas
