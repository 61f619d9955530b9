// SPDX-License-Identifier: MIT
#include "atlas/fusion/measurement.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {

void addNearSurface(const TrackShape& track, const Eigen::Vector2d& direction, TrackVector& h) {
  const double c = std::max(std::abs(direction.dot(track.along())), 1e-6);
  const double s = std::max(std::abs(direction.dot(track.across())), 1e-6);
  if (track.length() / c < track.width() / s) {
    h(kLength) = -0.5 / c;
  } else {
    h(kWidth) = -0.5 / s;
  }
}

}  // namespace atlas
