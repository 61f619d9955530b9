// SPDX-License-Identifier: MIT
#include "atlas/camera/virtual_camera.hpp"

#include <cmath>
#include <stdexcept>

namespace atlas {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kLargestSide_px = 8192;

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("virtual camera: " + field + " must be " + need + ", got " +
                              std::to_string(value));
}

}  // namespace

void validate(const VirtualCameraParams& params) {
  for (const auto& [field, value] : {std::pair{"x_m", params.x_m},
                                     {"y_m", params.y_m},
                                     {"z_m", params.z_m},
                                     {"pitch_deg", params.pitch_deg},
                                     {"yaw_deg", params.yaw_deg}}) {
    if (!std::isfinite(value)) reject(field, "finite", value);
  }
  for (const auto& [field, value] :
       {std::pair{"width_px", params.width_px}, {"height_px", params.height_px}}) {
    if (value < 1 || value > kLargestSide_px) reject(field, "in 1..8192", value);
  }
  if (!(params.focal_px > 0.0 && std::isfinite(params.focal_px)))
    reject("focal_px", "positive", params.focal_px);
}

Pose T_imu_virtual(const VirtualCameraParams& params) {
  const Eigen::Quaterniond looks_forward(0.5, -0.5, 0.5, -0.5);
  const RollPitchYaw attitude{0.0, params.pitch_deg * kDegree, params.yaw_deg * kDegree};
  return {fromRollPitchYaw(attitude) * looks_forward, {params.x_m, params.y_m, params.z_m}};
}

CameraInfo virtualInfo(const VirtualCameraParams& params, Stamp stamp) {
  CameraInfo info;
  info.stamp = stamp;
  info.frame = params.name;
  info.width = static_cast<std::uint32_t>(params.width_px);
  info.height = static_cast<std::uint32_t>(params.height_px);
  info.K = {params.focal_px,
            0,
            0.5 * (params.width_px - 1),
            0,
            params.focal_px,
            0.5 * (params.height_px - 1),
            0,
            0,
            1};
  return info;
}

}  // namespace atlas
