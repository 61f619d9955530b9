// SPDX-License-Identifier: MIT
#include "atlas/fusion/radar_sign.hpp"

#include <cmath>

namespace atlas {
namespace {

constexpr double kLeast_mps = 1.5;  ///< slower, both signs fit
constexpr double kFits_mps = 0.5;
constexpr std::uint64_t kVotes = 20, kClear = 3;

}  // namespace

void RadarSign::add(double recorded_mps, double standing_mps) {
  if (!std::isfinite(recorded_mps) || std::abs(standing_mps) < kLeast_mps) return;
  if (std::abs(recorded_mps - standing_mps) < kFits_mps) ++away_;
  if (std::abs(recorded_mps + standing_mps) < kFits_mps) ++towards_;
}

std::optional<double> RadarSign::sign() const {
  if (away_ + towards_ < kVotes) return std::nullopt;
  if (away_ > kClear * towards_) return 1.0;
  if (towards_ > kClear * away_) return -1.0;
  return std::nullopt;
}

}  // namespace atlas
