// SPDX-License-Identifier: MIT
#include "atlas/camera/frustum.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {
namespace {

constexpr double kMadToSigma = 1.4826;        // of a normal distribution: 1 / (quantile of 0.75)
constexpr double kMedianEfficiency = 1.2533;  // sqrt(pi / 2): sigma of the median / sigma of the mean
constexpr double kRangeNoise_m =
    0.02;  // HDL-32E data sheet: +-2 cm; shared by all points, so not divided by sqrt(n)

double median(std::vector<float>& values) {
  const std::size_t half = values.size() / 2;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(half);
  std::nth_element(values.begin(), middle, values.end());
  const double upper = *middle;
  if (values.size() % 2 == 1) return upper;
  return 0.5 * (upper + *std::max_element(values.begin(), middle));
}

}  // namespace

// sigma^2 = (sqrt(pi/2) * 1.4826 * MAD)^2 / n + range noise^2   (Rousseeuw and Croux 1993 for the scale by
// the MAD)
Outcome<RobustDepth> robustDepth(std::vector<float>& depths_m) {
  if (depths_m.empty()) return Reason::kNoPoints;
  RobustDepth result;
  result.median_m = median(depths_m);
  for (float& depth : depths_m) depth = static_cast<float>(std::abs(depth - result.median_m));
  const double spread = kMedianEfficiency * kMadToSigma * median(depths_m);
  result.sigma_m =
      std::sqrt(spread * spread / static_cast<double>(depths_m.size()) + kRangeNoise_m * kRangeNoise_m);
  return result;
}

Outcome<Detection2d> clipToImage(const Detection2d& box, const CameraModel& model) {
  if (!std::isfinite(box.x_min) || !std::isfinite(box.y_min) || !std::isfinite(box.x_max) ||
      !std::isfinite(box.y_max)) {
    return Reason::kNotFinite;
  }
  Detection2d clipped = box;
  clipped.x_min = std::max(box.x_min, -0.5);
  clipped.y_min = std::max(box.y_min, -0.5);
  clipped.x_max = std::min(box.x_max, model.width() - 0.5);
  clipped.y_max = std::min(box.y_max, model.height() - 0.5);
  if (clipped.x_min >= clipped.x_max || clipped.y_min >= clipped.y_max) return Reason::kEmpty;
  return clipped;
}

Outcome<Frustum> makeFrustum(const Detection2d& box_in_image, const RobustDepth& depth, double object_depth_m,
                             const CameraModel& model, const Pose& T_map_camera) {
  const Detection2d& box = box_in_image;
  const std::array<Eigen::Vector2d, 4> corners_px = {
      Eigen::Vector2d(box.x_min, box.y_min), Eigen::Vector2d(box.x_max, box.y_min),
      Eigen::Vector2d(box.x_max, box.y_max), Eigen::Vector2d(box.x_min, box.y_max)};
  Frustum frustum;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto bearing = model.bearing(corners_px[i]);
    if (!bearing) return Reason::kNotFinite;
    frustum.corners[i] = T_map_camera * Eigen::Vector3d(*bearing * depth.median_m);
    frustum.corners[i + 4] = T_map_camera * Eigen::Vector3d(*bearing * (depth.median_m + object_depth_m));
  }
  const auto center = model.bearing({0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)});
  if (!center) return Reason::kNotFinite;
  const Eigen::Vector3d p_camera = *center * depth.median_m;
  frustum.distance_m = depth.median_m;
  frustum.depth_sigma_m = depth.sigma_m;
  frustum.range_m = p_camera.norm();
  frustum.position = T_map_camera * p_camera;
  return frustum;
}

}  // namespace atlas
