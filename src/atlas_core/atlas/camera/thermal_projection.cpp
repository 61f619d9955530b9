// SPDX-License-Identifier: MIT
#include "atlas/camera/thermal_projection.hpp"

#include <algorithm>
#include <limits>

namespace atlas {
namespace {
constexpr int kSamplesPerEdge = 16;
}

const char* toString(BoxLoss loss) {
  switch (loss) {
    case BoxLoss::kNone:
      return "none";
    case BoxLoss::kBehindCamera:
      return "behind the thermal camera";
    case BoxLoss::kOutsideImage:
      return "outside the thermal image";
    case BoxLoss::kMostlyOutside:
      return "mostly outside the thermal image";
    case BoxLoss::kTooSmall:
      return "too small in the thermal image";
  }
  return "unknown loss";
}

// Samples beyond the valid field of the lens are left out: that field is larger than the image, so they lie
// outside it.
BoxInImage projectFront(const Frustum& frustum, const CameraModel& model, const Pose& T_camera_map,
                        const ThermalBoxLimits& limits) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(kInfinity, kInfinity), high(-kInfinity, -kInfinity);
  bool any_in_front = false, any_seen = false;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const Eigen::Vector3d from = T_camera_map * frustum.corners[edge];
    const Eigen::Vector3d to = T_camera_map * frustum.corners[(edge + 1) % 4];
    for (int i = 0; i < kSamplesPerEdge; ++i) {
      const Eigen::Vector3d p_camera = from + (to - from) * (static_cast<double>(i) / kSamplesPerEdge);
      any_in_front = any_in_front || p_camera.z() > 0.0;
      const auto pixel = model.project(p_camera);
      if (!pixel) continue;
      any_seen = true;
      low = low.cwiseMin(*pixel);
      high = high.cwiseMax(*pixel);
    }
  }
  if (!any_in_front) return {BoxLoss::kBehindCamera, {}};
  if (!any_seen) return {BoxLoss::kOutsideImage, {}};
  Detection2d box = frustum.detection;
  box.x_min = std::max(low.x(), -0.5);  // the outer edges of the first and last pixels
  box.y_min = std::max(low.y(), -0.5);
  box.x_max = std::min(high.x(), model.width() - 0.5);
  box.y_max = std::min(high.y(), model.height() - 0.5);
  const double width = box.x_max - box.x_min, height = box.y_max - box.y_min;
  if (width <= 0.0 || height <= 0.0) return {BoxLoss::kOutsideImage, {}};
  const double visible = width * height / ((high.x() - low.x()) * (high.y() - low.y()));
  if (visible < limits.min_visible_fraction) return {BoxLoss::kMostlyOutside, {}};
  if (width < limits.min_box_px || height < limits.min_box_px) return {BoxLoss::kTooSmall, {}};
  return {BoxLoss::kNone, box};
}

}  // namespace atlas
