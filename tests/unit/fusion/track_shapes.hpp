// SPDX-License-Identifier: MIT
// A track as the tests of measurements need it.
#pragma once

#include "atlas/fusion/measurement.hpp"

namespace atlas::test {

/// A car of 4.4 x 1.8 m at a place, heading along x.
inline TrackShape car(double x, double y) {
  TrackShape shape;
  shape.state.mean << x, y, 0.0, 0.0, 0.0, 4.4, 1.8;
  shape.state.covariance = (TrackVector() << 0.1, 0.1, 1.0, 1.0, 0.1, 0.5, 0.2).finished().asDiagonal();
  shape.middle_z_m = {0.8, 0.1};
  shape.height_m = {1.5, 0.1};
  return shape;
}
inline double residual(const LinearRow& row, const TrackShape& track) {
  return row.z - row.h.dot(track.state.mean);
}

}  // namespace atlas::test
