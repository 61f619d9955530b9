// SPDX-License-Identifier: MIT
#include "atlas/camera/box_occlusion.hpp"

#include <algorithm>
#include <limits>

namespace atlas {
namespace {
constexpr float kNothing = std::numeric_limits<float>::infinity();
}

BoxOcclusion::BoxOcclusion(const Detection2d& box, double front_m, const OcclusionParams& params)
    : box_(box),
      limit_m_(static_cast<float>(front_m - params.least_step_m - params.step_share * front_m)),
      least_cells_(params.least_cells) {
  nearest_m_.fill(kNothing);
}

void BoxOcclusion::add(const ProjectedPoint& point) {
  const double x = (static_cast<double>(point.u) - box_.x_min) / (box_.x_max - box_.x_min);
  const double y = (static_cast<double>(point.v) - box_.y_min) / (box_.y_max - box_.y_min);
  if (!(x >= 0.0 && x < 1.0 && y >= 0.0 && y < 1.0)) return;
  float& cell = nearest_m_.at(
      static_cast<std::size_t>(static_cast<int>(y * kSide) * kSide + static_cast<int>(x * kSide)));
  cell = std::min(cell, point.depth_m);
}

std::optional<double> BoxOcclusion::hiddenShare() const {
  int seen = 0, hidden = 0;
  for (const float depth_m : nearest_m_) {
    if (depth_m == kNothing) continue;
    ++seen;
    if (depth_m < limit_m_) ++hidden;
  }
  if (seen < std::max(1, least_cells_)) return std::nullopt;
  return static_cast<double>(hidden) / seen;
}

}  // namespace atlas
