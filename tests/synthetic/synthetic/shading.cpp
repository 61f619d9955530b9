// SPDX-License-Identifier: MIT
#include "synthetic/shading.hpp"

#include <algorithm>
#include <cmath>

#include "synthetic/ground.hpp"

namespace atlas::synthetic {
namespace {

using Colour = std::array<float, 3>;

/// What lies under a pixel.
struct Surface {
  const Primitive* primitive;  ///< nullptr for the ground and the sky
  int hit;
  float depth;
  Eigen::Vector3f direction;  ///< city frame, z-depth 1
  Eigen::Vector3d p_city;
  Eigen::Vector3f local;   ///< relative to the primitive's centre, in its axes
  Eigen::Vector3f normal;  ///< city frame
};

std::uint32_t hash(std::int32_t a, std::int32_t b, std::uint32_t c) {  // a finalizer of MurmurHash3
  std::uint32_t h = static_cast<std::uint32_t>(a) * 0x9E3779B1U ^
                    static_cast<std::uint32_t>(b) * 0x85EBCA77U ^ c * 0xC2B2AE3DU;
  h ^= h >> 16U;
  h *= 0x7FEB352DU;
  h ^= h >> 15U;
  return h;
}
/// Random grain of -1..1 in cells of a size.
float grain(float u, float v, float cell, std::uint32_t seed) {
  const auto a = static_cast<std::int32_t>(std::floor(u / cell)),
             b = static_cast<std::int32_t>(std::floor(v / cell));
  return static_cast<float>(hash(a, b, seed) & 255U) / 127.5F - 1.0F;
}

Surface surfaceAt(const View& view, const Eigen::Matrix3f& R_city_camera, const Eigen::Vector2f& tangent,
                  std::size_t pixel) {
  Surface s{};
  s.hit = view.hit[pixel];
  s.depth = view.depth[pixel];
  s.direction = R_city_camera * Eigen::Vector3f(tangent.x(), tangent.y(), 1.0F);
  s.p_city = view.T_city_camera.translation + (s.depth * s.direction).cast<double>();
  s.normal = Eigen::Vector3f::UnitZ();
  if (s.hit < 0) return s;
  s.primitive = &view.snapshot.primitives[s.hit];
  const Eigen::Vector3f d = (s.p_city - s.primitive->centre).cast<float>(),
                        half = s.primitive->half.cast<float>();
  const auto c = static_cast<float>(std::cos(s.primitive->yaw)),
             sine = static_cast<float>(std::sin(s.primitive->yaw));
  s.local = {c * d.x() + sine * d.y(), c * d.y() - sine * d.x(), d.z()};
  Eigen::Vector3f n = Eigen::Vector3f::Zero();
  if (s.primitive->shape == Shape::kBox) {
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (half[k] - std::fabs(s.local[k]) < half[axis] - std::fabs(s.local[axis])) axis = k;
    }
    n[axis] = s.local[axis] > 0.0F ? 1.0F : -1.0F;
  } else if (s.primitive->shape == Shape::kCylinder) {
    n = half.z() - s.local.z() < 1e-3F ? Eigen::Vector3f(0.0F, 0.0F, 1.0F)
                                       : Eigen::Vector3f(s.local.x(), s.local.y(), 0.0F).normalized();
  } else {
    n = Eigen::Vector3f(s.local.x() / (half.x() * half.x()), s.local.y() / (half.y() * half.y()),
                        s.local.z() / (half.z() * half.z()))
            .normalized();
  }
  s.normal = {c * n.x() - sine * n.y(), sine * n.x() + c * n.y(), n.z()};
  return s;
}

/// Windows on a house: cells of 3 m by 3 m, glass in the middle. True on glass.
bool onWindow(const Surface& s) {
  const Eigen::Vector3f half = s.primitive->half.cast<float>();
  const bool face_x = half.x() - std::fabs(s.local.x()) < half.y() - std::fabs(s.local.y());
  const float along = (face_x ? s.local.y() + half.y() : s.local.x() + half.x());
  const float up = s.local.z() + half.z() - 2.0F;
  if (half.z() - s.local.z() < 0.6F || up < 0.4F) return false;
  const float u = along / 3.0F - std::floor(along / 3.0F), v = up / 3.0F - std::floor(up / 3.0F);
  return u > 0.25F && u < 0.72F && v > 0.3F && v < 0.8F;
}

/// Paint of the road: middle line in dashes, edge of the parking lane.
bool onMarking(double x, double y) {
  const double across_x = acrossStreet(x), across_y = acrossStreet(y);
  const bool street_x = std::fabs(across_y) < kHalfCarriageway,
             street_y = std::fabs(across_x) < kHalfCarriageway;
  if (street_x == street_y) return false;  // crossings are bare
  const double across = street_x ? across_y : across_x, along = street_x ? x : y;
  const double to_crossing = std::fabs(street_x ? across_x : across_y) - kHalfCarriageway;
  if (to_crossing > 1.0 && to_crossing < 4.0) return std::fmod(std::fabs(across) + 0.25, 1.0) < 0.5;  // zebra
  if (to_crossing < 5.0) return false;
  return std::fabs(across) < 0.07 && along / 6.0 - std::floor(along / 6.0) < 0.5;
}

Colour groundColour(const Surface& s) {
  const auto x = static_cast<float>(s.p_city.x()), y = static_cast<float>(s.p_city.y());
  const float fade = std::clamp(1.0F - s.depth / 60.0F, 0.0F, 1.0F);
  if (s.hit == kHitKerb) return {150, 148, 142};
  if (s.hit == kHitSidewalk) {
    const float joint =
        (x - std::floor(x) < 0.04F || y - std::floor(y) < 0.04F) && s.depth < 25.0F ? -25.0F : 0.0F;
    const float g = 148.0F + joint + fade * 8.0F * grain(x, y, 1.0F, 3);
    return {g, g - 4.0F, g - 12.0F};
  }
  if (onMarking(s.p_city.x(), s.p_city.y())) return {215, 215, 210};
  const float g = 82.0F + fade * (5.0F * grain(x, y, 0.15F, 1) + 4.0F * grain(x, y, 1.7F, 2));
  return {g, g, g + 3.0F};
}

Colour skyColour(const Eigen::Vector3f& direction) {
  const float up = std::clamp(direction.normalized().z(), 0.0F, 1.0F);
  return {200.0F - 95.0F * up, 215.0F - 65.0F * up, 235.0F - 15.0F * up};
}

Colour primitiveColour(const Surface& s) {
  const Primitive& p = *s.primitive;
  Colour colour{static_cast<float>(p.colour[0]), static_cast<float>(p.colour[1]),
                static_cast<float>(p.colour[2])};
  const float fade = std::clamp(1.0F - s.depth / 50.0F, 0.0F, 1.0F);
  const auto shift = [&](float by) {
    for (float& channel : colour) channel = std::clamp(channel + by, 0.0F, 255.0F);
  };
  if (p.material == Material::kBuilding && s.normal.z() < 0.5F) {
    if (onWindow(s)) return {62, 72, 86};
    shift(6.0F * fade * grain(s.local.x() + s.local.y(), s.local.z(), 0.4F, p.variant));
  } else if (p.material == Material::kCrown) {
    shift(26.0F * (0.3F + 0.7F * fade) *
          grain(s.local.x() + 0.7F * s.local.y(), s.local.z(), 0.28F, p.variant));
  } else if (p.material == Material::kCarGlass && s.normal.z() < 0.5F) {
    const float border = static_cast<float>(p.half.z()) - std::fabs(s.local.z());
    if (border > 0.07F) return {38, 44, 52};
  } else if (p.material == Material::kTrunk || p.material == Material::kCloth) {
    shift(10.0F * fade * grain(s.local.z(), s.local.x(), 0.12F, p.variant + 5));
  }
  return colour;
}

/// deg C.
float temperature(const Surface& s, float height) {
  if (s.hit == kHitNothing)
    return -28.0F + 22.0F * (1.0F - std::clamp(s.direction.normalized().z() * 2.0F, 0.0F, 1.0F));
  const auto x = static_cast<float>(s.p_city.x()), y = static_cast<float>(s.p_city.y());
  if (s.hit == kHitRoad)
    return 13.5F + 0.4F * grain(x, y, 0.5F, 7) + (onMarking(s.p_city.x(), s.p_city.y()) ? -1.0F : 0.0F);
  if (s.hit < 0) return 15.0F + 0.4F * grain(x, y, 0.5F, 8);
  const Primitive& p = *s.primitive;
  const bool running = p.object > 0 && p.object < 10000;
  switch (p.material) {
    case Material::kBuilding:
      return onWindow(s) ? 8.0F : 11.0F + 0.02F * static_cast<float>(p.variant % 100);
    case Material::kCrown:
      return 9.0F + 0.8F * grain(s.local.x(), s.local.z(), 0.4F, 9);
    case Material::kTrunk:
      return 10.5F;
    case Material::kMetal:
      return p.variant == 1 && running ? 27.0F : 10.0F;  // variant 1: wheels
    case Material::kCarBody:
      return running && s.local.x() > 0.4F * static_cast<float>(p.half.x()) ? 26.0F : running ? 17.0F : 12.0F;
    case Material::kCarGlass:
      return running ? 14.0F : 7.0F;
    case Material::kCloth:
      return 24.0F + 2.0F * height;
    case Material::kSkin:
      return 33.0F;
    default:
      return 12.0F;
  }
}

}  // namespace

std::vector<std::uint8_t> paint(const View& view, const CameraView& camera) {
  static const Eigen::Vector3f kSun = Eigen::Vector3f(0.45F, -0.35F, 0.82F).normalized();
  const Eigen::Matrix3f R = view.T_city_camera.rotation.toRotationMatrix().cast<float>();
  std::vector<std::uint8_t> rgb(3 * view.hit.size());
  for (std::size_t pixel = 0; pixel < view.hit.size(); ++pixel) {
    const Surface s = surfaceAt(view, R, camera.tangent(static_cast<int>(pixel)), pixel);
    Colour colour = s.hit == kHitNothing ? skyColour(s.direction)
                    : s.hit < 0          ? groundColour(s)
                                         : primitiveColour(s);
    if (s.hit != kHitNothing) {
      const float light = 0.62F + 0.42F * std::max(0.0F, s.normal.dot(kSun));
      const float haze = std::min(0.35F, s.depth / 500.0F);
      const Colour sky{200, 212, 228};
      for (int k = 0; k < 3; ++k) colour[k] = (1.0F - haze) * light * colour[k] + haze * sky[k];
    }
    for (int k = 0; k < 3; ++k)
      rgb[3 * pixel + k] = static_cast<std::uint8_t>(std::clamp(colour[k], 0.0F, 255.0F));
  }
  return rgb;
}

ThermalPicture paintThermal(const View& view, const CameraView& camera, std::uint32_t noise_seed) {
  const Eigen::Matrix3f R = view.T_city_camera.rotation.toRotationMatrix().cast<float>();
  std::vector<float> degrees(view.hit.size());
  float low = 1e9F, high = -1e9F;
  for (std::size_t pixel = 0; pixel < view.hit.size(); ++pixel) {
    const Surface s = surfaceAt(view, R, camera.tangent(static_cast<int>(pixel)), pixel);
    const float height =
        s.primitive != nullptr ? s.local.z() / static_cast<float>(s.primitive->half.z()) : 0.0F;
    const auto at = static_cast<std::int32_t>(pixel);
    degrees[pixel] =
        temperature(s, height) + 0.15F * (static_cast<float>(hash(at, 0, noise_seed) & 255U) / 127.5F - 1.0F);
    low = std::min(low, degrees[pixel]);
    high = std::max(high, degrees[pixel]);
  }
  ThermalPicture picture;  // the range as the file gives it, with two decimals
  picture.minimum_degc = std::floor(static_cast<double>(low) * 100.0) / 100.0;
  picture.maximum_degc = std::ceil(static_cast<double>(high) * 100.0) / 100.0;
  picture.grey.resize(degrees.size());
  const auto scale = static_cast<float>(255.0 / (picture.maximum_degc - picture.minimum_degc));
  const auto zero = static_cast<float>(picture.minimum_degc);
  for (std::size_t i = 0; i < degrees.size(); ++i)
    picture.grey[i] = static_cast<std::uint8_t>(std::lround(scale * (degrees[i] - zero)));
  return picture;
}

}  // namespace atlas::synthetic
