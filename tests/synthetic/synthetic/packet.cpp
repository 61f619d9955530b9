// SPDX-License-Identifier: MIT
#include "synthetic/packet.hpp"

#include <algorithm>
#include <cmath>

#include "synthetic/ground.hpp"

namespace atlas::synthetic {
namespace {

constexpr float kNotParallel = 1e-9F;

// Boxes: slab method (Kay and Kajiya 1986) in the box's own axes.
void traceBox(RayPacket& packet, const PreparedPrimitive& p, int index, int first, int last) {
  for (int i = first; i < last; ++i) {
    float rx = p.cosine * packet.dx[i] + p.sine * packet.dy[i];
    float ry = p.cosine * packet.dy[i] - p.sine * packet.dx[i];
    float rz = packet.dz[i];
    rx = std::fabs(rx) < kNotParallel ? kNotParallel : rx;
    ry = std::fabs(ry) < kNotParallel ? kNotParallel : ry;
    rz = std::fabs(rz) < kNotParallel ? kNotParallel : rz;
    const float ix = 1.0F / rx, iy = 1.0F / ry, iz = 1.0F / rz;
    const float mx = -p.ox * ix, my = -p.oy * iy, mz = -p.oz * iz;
    const float kx = p.hx * std::fabs(ix), ky = p.hy * std::fabs(iy), kz = p.hz * std::fabs(iz);
    const float yz_near = my - ky > mz - kz ? my - ky : mz - kz;
    const float near = mx - kx > yz_near ? mx - kx : yz_near;
    const float yz_far = my + ky < mz + kz ? my + ky : mz + kz;
    const float far = mx + kx < yz_far ? mx + kx : yz_far;
    const bool better = (near <= far) & (near > 0.0F) & (near < packet.t[i]);
    packet.t[i] = better ? near : packet.t[i];
    packet.hit[i] = better ? index : packet.hit[i];
  }
}

// Side of the cylinder: |o + t d|^2 = r^2 in the plane; top: the plane z = hz.
void traceCylinder(RayPacket& packet, const PreparedPrimitive& p, int index, int first, int last) {
  const float c = p.ox * p.ox + p.oy * p.oy - p.hx * p.hx;
  for (int i = first; i < last; ++i) {
    const float rx = p.cosine * packet.dx[i] + p.sine * packet.dy[i];
    const float ry = p.cosine * packet.dy[i] - p.sine * packet.dx[i];
    float rz = packet.dz[i];
    rz = std::fabs(rz) < kNotParallel ? kNotParallel : rz;
    const float a = std::max(rx * rx + ry * ry, 1e-12F), b = p.ox * rx + p.oy * ry;
    const float discriminant = b * b - a * c;
    const float side = (-b - std::sqrt(std::max(discriminant, 0.0F))) / a;
    const float z = p.oz + side * rz;
    const bool on_side = (discriminant > 0.0F) & (std::fabs(z) <= p.hz) & (side > 0.0F);
    const float top = (p.hz - p.oz) / rz;
    const float px = p.ox + top * rx, py = p.oy + top * ry;
    const bool on_top = (px * px + py * py <= p.hx * p.hx) & (top > 0.0F) & (p.oz > p.hz);
    const float near = on_top ? top : side;
    const bool better = (on_side | on_top) & (near < packet.t[i]);
    packet.t[i] = better ? near : packet.t[i];
    packet.hit[i] = better ? index : packet.hit[i];
  }
}

// Ellipsoid of revolution: a sphere after dividing by the half axes.
void traceEllipsoid(RayPacket& packet, const PreparedPrimitive& p, int index, int first, int last) {
  const float ox = p.ox / p.hx, oy = p.oy / p.hx, oz = p.oz / p.hz;
  const float c = ox * ox + oy * oy + oz * oz - 1.0F;
  for (int i = first; i < last; ++i) {
    const float rx = (p.cosine * packet.dx[i] + p.sine * packet.dy[i]) / p.hx;
    const float ry = (p.cosine * packet.dy[i] - p.sine * packet.dx[i]) / p.hx;
    const float rz = packet.dz[i] / p.hz;
    const float a = rx * rx + ry * ry + rz * rz, b = ox * rx + oy * ry + oz * rz;
    const float discriminant = b * b - a * c;
    const float near = (-b - std::sqrt(std::max(discriminant, 0.0F))) / a;
    const bool better = (discriminant > 0.0F) & (near > 0.0F) & (near < packet.t[i]);
    packet.t[i] = better ? near : packet.t[i];
    packet.hit[i] = better ? index : packet.hit[i];
  }
}

// sin(2 pi u) for |u| < 100, error below 2e-6: the odd part of a Taylor polynomial after folding u to [-1/4,
// 1/4].
inline float sineOfTurns(float u) {
  u -= static_cast<float>(static_cast<int>(u + 128.5F)) - 128.0F;  // to [-1/2, 1/2)
  const float half = u > 0.0F ? 0.5F : -0.5F;
  u = std::fabs(u) > 0.25F ? half - u : u;
  const float x = 6.28318531F * u, x2 = x * x;
  return x * (1.0F + x2 * (-1.6666667e-1F +
                           x2 * (8.3333333e-3F +
                                 x2 * (-1.9841270e-4F + x2 * (2.7557319e-6F - x2 * 2.5052108e-8F)))));
}

/// Both waves of the ground around an origin.
struct LocalGround {
  float phase_x, phase_y;
  explicit LocalGround(const Eigen::Vector3d& origin) {
    const double u = origin.x() / kWaveX.length + kWaveX.phase, v = origin.y() / kWaveY.length + kWaveY.phase;
    phase_x = static_cast<float>(u - std::floor(u));
    phase_y = static_cast<float>(v - std::floor(v));
  }
};

// Marches down to the surface `road + offset` and never through it. With clearance f, its derivative f' along
// the ray and a bound K of |f''|, f(t + d) >= f + f' d - K d^2 / 2 > 0 for d below the positive root, which
// is the step: Newton's where the ray is steep, long where it skims. t ends at `limit` where the surface is
// not reached. The clearance below which a ray has arrived is 0.2 mm.
void marchGround(const RayPacket& packet, float offset, float* t, const float* limit) {
  constexpr float kTwoPi = 6.28318531F, kArrived = 2e-4F;
  const LocalGround local(packet.origin);
  const auto ax = static_cast<float>(kWaveX.amplitude), ay = static_cast<float>(kWaveY.amplitude);
  const auto fx = static_cast<float>(1.0 / kWaveX.length), fy = static_cast<float>(1.0 / kWaveY.length);
  const float bend = kTwoPi * kTwoPi * (ax * fx * fx > ay * fy * fy ? ax * fx * fx : ay * fy * fy);
  const float z0 = static_cast<float>(packet.origin.z()) - offset;
  for (int round = 0; round < 24; ++round) {
    int moving = 0;
    for (int i = 0; i < packet.size; ++i) {
      const float x = packet.dx[i], y = packet.dy[i];
      const float u = local.phase_x + t[i] * x * fx, v = local.phase_y + t[i] * y * fy;
      const float clearance = z0 + t[i] * packet.dz[i] - ax * sineOfTurns(u) - ay * sineOfTurns(v);
      const float slope = packet.dz[i] - kTwoPi * (ax * fx * x * sineOfTurns(u + 0.25F) +
                                                   ay * fy * y * sineOfTurns(v + 0.25F));
      const float curve = bend * (x * x + y * y) + 1e-9F;
      const float positive = std::max(clearance, 0.0F);
      const float root = std::sqrt(slope * slope + 2.0F * curve * positive);
      // The two forms of the root, each where it does not cancel.
      const float forward = slope < 0.0F ? 2.0F * positive / (root - slope) : (slope + root) / curve;
      const bool go = (clearance > kArrived) & (t[i] < limit[i]);
      t[i] = go ? std::min(t[i] + forward, limit[i]) : t[i];
      moving |= go;
    }
    if (moving == 0) return;
  }
}

/// Enters the block that holds the point at `to`, coming over the road at `from`: where the ray crosses the
/// kerb.
float kerbCrossing(const RayPacket& packet, int i, float from, float to) {
  const double bx = packet.origin.x() + static_cast<double>(to * packet.dx[i]);
  const double by = packet.origin.y() + static_cast<double>(to * packet.dy[i]);
  float enter = from;
  const auto cross = [&](double origin, double at_to, float direction) {
    if (std::fabs(direction) < kNotParallel) return;
    const double cell = std::floor(at_to / kBlockPitch) * kBlockPitch;
    const double edge = direction > 0.0F ? cell + kHalfCarriageway : cell + kBlockPitch - kHalfCarriageway;
    enter = std::max(enter, static_cast<float>((edge - origin) / static_cast<double>(direction)));
  };
  cross(packet.origin.x(), bx, packet.dx[i]);
  cross(packet.origin.y(), by, packet.dy[i]);
  return std::min(enter, to);
}

}  // namespace

void RayPacket::reset(float limit) {
  std::fill_n(t.begin(), size, limit);
  std::fill_n(hit.begin(), size, kHitNothing);
}

void traceGround(RayPacket& packet) {
  bool any = false;
  for (int i = 0; i < packet.size; ++i) {
    const float across = std::fabs(packet.dx[i]) + std::fabs(packet.dy[i]);
    any |= packet.dz[i] < 0.05F * across;  // slopes of the ground stay below 5 % in every direction
  }
  if (!any) return;
  alignas(32) std::array<float, RayPacket::kCapacity> upper{}, lower{};
  marchGround(packet, static_cast<float>(kKerbHeight), upper.data(), packet.t.data());
  std::copy_n(upper.begin(), packet.size, lower.begin());
  marchGround(packet, 0.0F, lower.data(), packet.t.data());
  const auto over_block = [&](int i, float t) {
    return onBlock(packet.origin.x() + static_cast<double>(t * packet.dx[i]),
                   packet.origin.y() + static_cast<double>(t * packet.dy[i]));
  };
  for (int i = 0; i < packet.size; ++i) {
    if (upper[i] < packet.t[i] && over_block(i, upper[i])) {
      packet.t[i] = upper[i];
      packet.hit[i] = kHitSidewalk;
    } else if (lower[i] < packet.t[i]) {
      const bool kerb = over_block(i, lower[i]);
      packet.t[i] = kerb ? kerbCrossing(packet, i, upper[i], lower[i]) : lower[i];
      packet.hit[i] = kerb ? kHitKerb : kHitRoad;
    }
  }
}

PreparedPrimitive prepare(const Primitive& primitive, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d o = origin - primitive.centre;
  const double c = std::cos(primitive.yaw), s = std::sin(primitive.yaw);
  return {primitive.shape,
          static_cast<float>(c * o.x() + s * o.y()),
          static_cast<float>(c * o.y() - s * o.x()),
          static_cast<float>(o.z()),
          static_cast<float>(c),
          static_cast<float>(s),
          static_cast<float>(primitive.half.x()),
          static_cast<float>(primitive.half.y()),
          static_cast<float>(primitive.half.z())};
}

void tracePrimitive(RayPacket& packet, const PreparedPrimitive& primitive, int index, int first, int last) {
  switch (primitive.shape) {
    case Shape::kBox:
      return traceBox(packet, primitive, index, first, last);
    case Shape::kCylinder:
      return traceCylinder(packet, primitive, index, first, last);
    case Shape::kEllipsoid:
      return traceEllipsoid(packet, primitive, index, first, last);
  }
}

}  // namespace atlas::synthetic
