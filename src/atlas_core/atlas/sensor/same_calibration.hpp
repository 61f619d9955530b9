// SPDX-License-Identifier: MIT
// A camera sends its intrinsics with every image; what is made of them is made once.
#pragma once

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// The same image size and lens; rectification (R, P) is not compared.
inline bool sameCalibration(const CameraInfo& a, const CameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model &&
         a.distortion == b.distortion && a.K == b.K;
}

}  // namespace atlas
