// SPDX-License-Identifier: MIT
#include "atlas/stereo/stereo_rig.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace atlas {
namespace {

constexpr int kLargestSide_px = 8192;

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("stereo rig: " + field + " must be " + need + ", got " + std::to_string(value));
}

}  // namespace

void validate(const StereoRig& rig) {
  for (const auto& [field, value] : {std::pair{"focal_px", rig.focal_px}, {"baseline_m", rig.baseline_m}}) {
    if (!(value > 0.0 && std::isfinite(value))) reject(field, "positive", value);
  }
  for (const auto& [field, value] : {std::pair{"u0_px", rig.u0_px}, {"v0_px", rig.v0_px}}) {
    if (!std::isfinite(value)) reject(field, "finite", value);
  }
  for (const auto& [field, value] : {std::pair{"width_px", rig.width_px}, {"height_px", rig.height_px}}) {
    if (value < 1 || value > kLargestSide_px) reject(field, "in 1..8192", value);
  }
}

}  // namespace atlas
