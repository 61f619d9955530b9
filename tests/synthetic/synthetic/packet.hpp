// SPDX-License-Identifier: MIT
// Ray casting of bundles of rays with a common origin: a column of a lidar, a tile of an image. Single
// precision relative to the origin (errors below 0.1 mm at 100 m), structure of arrays so that the compiler
// can use vector instructions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "synthetic/scene.hpp"

namespace atlas::synthetic {

/// Indices below zero in RayPacket::hit.
constexpr int kHitNothing = -1, kHitRoad = -2, kHitSidewalk = -3, kHitKerb = -4;

struct RayPacket {
  static constexpr int kCapacity = 256;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< city frame
  int size = 0;
  /// Directions in the city frame; length is free: `t` counts in it.
  alignas(32) std::array<float, kCapacity> dx, dy, dz;
  alignas(32) std::array<float, kCapacity> t;  ///< distance along the ray; `limit` where nothing was hit
  alignas(
      32) std::array<std::int32_t, kCapacity> hit;  ///< index of the primitive, or one of the constants above

  /// No hit yet: everything ends at `limit`.
  void reset(float limit);
};

/// Road, pavement and kerb. Call first: the primitives behind the ground are then skipped.
void traceGround(RayPacket& packet);

/// A primitive ready for packets that start near one origin.
struct PreparedPrimitive {
  Shape shape;
  float ox, oy, oz;    ///< origin of the rays relative to the centre, in the primitive's axes
  float cosine, sine;  ///< of its yaw
  float hx, hy, hz;    ///< half sizes
};
PreparedPrimitive prepare(const Primitive& primitive, const Eigen::Vector3d& origin);

/// Nearer hits of rays [first, last) get `index`.
void tracePrimitive(RayPacket& packet, const PreparedPrimitive& primitive, int index, int first, int last);

}  // namespace atlas::synthetic
