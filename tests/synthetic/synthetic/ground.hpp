// SPDX-License-Identifier: MIT
// The ground of the synthetic city, in the `city` frame (x, y along the streets, z up, m): two gentle waves
// under a chequered plan of streets, with kerbs. Streets run along x at y = j * kBlockPitch and along y at x
// = i * kBlockPitch.
#pragma once

#include <cmath>

namespace atlas::synthetic {

constexpr double kBlockPitch = 160.0;     ///< m between parallel streets
constexpr double kHalfCarriageway = 7.0;  ///< m from the middle of the street to the kerb
constexpr double kKerbHeight = 0.12;      ///< m, the pavement above the road
constexpr double kSidewalkWidth = 3.5;    ///< m, kerb to house front

/// h = sum of amplitude * sin(2 pi (u / length + phase)) over u = x and u = y; slopes stay below 2.5 %.
struct GroundWave {
  double amplitude, length, phase;
};
constexpr GroundWave kWaveX{0.8, 210.0, 0.064};
constexpr GroundWave kWaveY{0.6, 170.0, 0.175};

/// Height and slopes of the road surface.
struct GroundPoint {
  double height, slope_x, slope_y;
};
inline GroundPoint roadSurface(double x, double y) {
  const double ax = 2.0 * M_PI * (x / kWaveX.length + kWaveX.phase);
  const double ay = 2.0 * M_PI * (y / kWaveY.length + kWaveY.phase);
  return {kWaveX.amplitude * std::sin(ax) + kWaveY.amplitude * std::sin(ay),
          kWaveX.amplitude * 2.0 * M_PI / kWaveX.length * std::cos(ax),
          kWaveY.amplitude * 2.0 * M_PI / kWaveY.length * std::cos(ay)};
}

/// Signed distance to the middle of the nearest street across one axis, in [-pitch/2, pitch/2].
inline double acrossStreet(double u) { return u - kBlockPitch * std::round(u / kBlockPitch); }
/// True on a block (pavement and houses), false on the carriageways.
inline bool onBlock(double x, double y) {
  return std::fabs(acrossStreet(x)) > kHalfCarriageway && std::fabs(acrossStreet(y)) > kHalfCarriageway;
}
inline double groundHeight(double x, double y) {
  return roadSurface(x, y).height + (onBlock(x, y) ? kKerbHeight : 0.0);
}

}  // namespace atlas::synthetic
