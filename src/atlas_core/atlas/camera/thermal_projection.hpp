// SPDX-License-Identifier: MIT
// The front of a frustum seen by another camera: the box of its outline in that image (paper IV-D: "the
// frontal face"). The far plane is left out on purpose: how thick an object is was assumed, not measured, and
// would widen every box.
#pragma once

#include "atlas/camera/camera_model.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct ThermalBoxLimits {
  double min_box_px = 3.0;
  double min_visible_fraction = 0.3;
};

enum class BoxLoss { kNone, kBehindCamera, kOutsideImage, kMostlyOutside, kTooSmall };
const char* toString(BoxLoss loss);

struct BoxInImage {
  BoxLoss loss = BoxLoss::kNone;
  Detection2d box;  ///< clipped to the image, from -1/2 to width - 1/2; meaningful when loss is kNone
};

/// Projects the outline of the front plane, sampled along its edges because distortion bends them.
BoxInImage projectFront(const Frustum& frustum, const CameraModel& model, const Pose& T_camera_map,
                        const ThermalBoxLimits& limits);

}  // namespace atlas
