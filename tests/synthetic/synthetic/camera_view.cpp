// SPDX-License-Identifier: MIT
#include "synthetic/camera_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace atlas::synthetic {
namespace {

constexpr double kSmallSight =
    130.0;  // m: cars, trees and people beyond are not drawn, as they are a few pixels
constexpr float kNearPlane = 0.05F;  // m

std::array<Eigen::Vector3f, 8> corners(const Primitive& p, const Pose& T_camera_city) {
  std::array<Eigen::Vector3f, 8> result;
  const double c = std::cos(p.yaw), s = std::sin(p.yaw);
  for (int i = 0; i < 8; ++i) {
    const double x = (i & 1 ? 1 : -1) * p.half.x(), y = (i & 2 ? 1 : -1) * p.half.y(),
                 z = (i & 4 ? 1 : -1) * p.half.z();
    result[i] = (T_camera_city * (p.centre + Eigen::Vector3d(c * x - s * y, s * x + c * y, z))).cast<float>();
  }
  return result;
}

/// The tiles between whose two bounding planes (coordinate = bound * z) not all corners lie outside on one
/// side.
template <class Bounds>
std::pair<int, int> touched(const Bounds& bounds, const std::array<Eigen::Vector3f, 8>& p, int axis) {
  int first = static_cast<int>(bounds.size()), last = -1;
  for (int tile = 0; tile < static_cast<int>(bounds.size()); ++tile) {
    bool all_below = true, all_above = true;
    for (const Eigen::Vector3f& corner : p) {
      all_below &= corner[axis] < bounds[tile].low * corner.z();
      all_above &= corner[axis] > bounds[tile].high * corner.z();
    }
    if (all_below || all_above) continue;
    first = std::min(first, tile);
    last = tile;
  }
  return {first, last + 1};
}

/// The largest distance of a packet: positive floats are ordered as their bits are.
float farthest(const RayPacket& packet) {
  std::int32_t most = 0;
  for (int i = 0; i < packet.size; ++i) {
    std::int32_t bits;
    std::memcpy(&bits, &packet.t[i], sizeof bits);
    most = bits > most ? bits : most;
  }
  float result;
  std::memcpy(&result, &most, sizeof result);
  return result;
}

}  // namespace

CameraView::CameraView(const Camera& camera)
    : camera_(camera),
      columns_((camera.width + kTile - 1) / kTile),
      rows_((camera.height + kTile - 1) / kTile) {
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  tangent_x_.resize(pixels);
  tangent_y_.resize(pixels);
  column_bounds_.assign(columns_, {1e9F, -1e9F});
  row_bounds_.assign(rows_, {1e9F, -1e9F});
  const auto widen = [](Interval& bound, float value) {
    bound.low = std::min(bound.low, value);
    bound.high = std::max(bound.high, value);
  };
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2f tangent = camera.undistort({u, v}).cast<float>();
      const auto at = static_cast<std::size_t>(v * camera.width + u);
      tangent_x_[at] = tangent.x();
      tangent_y_[at] = tangent.y();
      widen(column_bounds_[u / kTile], tangent.x());
      widen(row_bounds_[v / kTile], tangent.y());
    }
  }
}

int CameraView::pixelOf(int column, int row, int i) const {
  const int width = std::min(kTile, camera_.width - column * kTile);
  return (row * kTile + i / width) * camera_.width + column * kTile + i % width;
}

RayPacket CameraView::tileRays(const View& view, int column, int row) const {
  RayPacket packet;
  packet.origin = view.T_city_camera.translation;
  const int width = std::min(kTile, camera_.width - column * kTile),
            height = std::min(kTile, camera_.height - row * kTile);
  packet.size = width * height;
  const Eigen::Matrix3f R = view.T_city_camera.rotation.toRotationMatrix().cast<float>();
  int n = 0;
  for (int y = 0; y < height; ++y) {
    const std::size_t line = static_cast<std::size_t>((row * kTile + y) * camera_.width + column * kTile);
    for (int x = 0; x < width; ++x, ++n) {
      const float tx = tangent_x_[line + x], ty = tangent_y_[line + x];
      packet.dx[n] = R(0, 0) * tx + R(0, 1) * ty + R(0, 2);
      packet.dy[n] = R(1, 0) * tx + R(1, 1) * ty + R(1, 2);
      packet.dz[n] = R(2, 0) * tx + R(2, 1) * ty + R(2, 2);
    }
  }
  packet.reset(kSight);
  return packet;
}

std::vector<CameraView::Reach> CameraView::reaches(const View& view) const {
  const Pose T_camera_city = view.T_city_camera.inverse();
  std::vector<Reach> result;
  for (int index = 0; index < static_cast<int>(view.snapshot.primitives.size()); ++index) {
    const Primitive& primitive = view.snapshot.primitives[index];
    const double away = (primitive.centre - view.T_city_camera.translation).head<2>().norm();
    if (primitive.material != Material::kBuilding && away > kSmallSight) continue;
    const auto p = corners(primitive, T_camera_city);
    float near = p[0].z(), far = p[0].z();
    for (const Eigen::Vector3f& corner : p) {
      near = std::min(near, corner.z());
      far = std::max(far, corner.z());
    }
    if (far < kNearPlane || near > kSight) continue;
    const auto [column_begin, column_end] = touched(column_bounds_, p, 0);
    if (column_begin >= column_end) continue;
    const auto [row_begin, row_end] = touched(row_bounds_, p, 1);
    if (row_begin < row_end)
      result.push_back({std::max(near, 0.0F), index, column_begin, column_end, row_begin, row_end});
  }
  std::sort(result.begin(), result.end(), [](const Reach& a, const Reach& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest : a.index < b.index;
  });
  return result;
}

View CameraView::look(const Scene& scene, const Pose& T_city_camera, double t_s) const {
  View view;
  view.T_city_camera = T_city_camera;
  view.snapshot = scene.snapshot(T_city_camera.translation, static_cast<double>(kSight), t_s);
  view.depth.resize(tangent_x_.size());
  view.hit.resize(tangent_x_.size());
  std::vector<std::vector<Reach>> of_tile(static_cast<std::size_t>(columns_ * rows_));
  for (const Reach& reach : reaches(view)) {
    for (int row = reach.row_begin; row < reach.row_end; ++row) {
      for (int column = reach.column_begin; column < reach.column_end; ++column)
        of_tile[row * columns_ + column].push_back(reach);
    }
  }
  std::vector<PreparedPrimitive> prepared;
  for (const Primitive& primitive : view.snapshot.primitives)
    prepared.push_back(prepare(primitive, T_city_camera.translation));
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      RayPacket packet = tileRays(view, column, row);
      traceGround(packet);
      for (const Reach& reach : of_tile[row * columns_ + column]) {
        if (reach.nearest > farthest(packet)) break;
        tracePrimitive(packet, prepared[reach.index], reach.index, 0, packet.size);
      }
      for (int i = 0; i < packet.size; ++i) {
        const int pixel = pixelOf(column, row, i);
        view.depth[pixel] = packet.t[i];
        view.hit[pixel] = packet.hit[i];
      }
    }
  }
  return view;
}

std::vector<CameraView::Outline> CameraView::outlines(const View& view,
                                                      const std::vector<int>& objects) const {
  std::vector<Outline> result;
  for (const int object : objects) result.push_back({object, 0});
  std::vector<std::vector<Reach>> parts(objects.size());
  for (const Reach& reach : reaches(view)) {
    const int object = view.snapshot.primitives[reach.index].object;
    const auto it = std::lower_bound(objects.begin(), objects.end(), object);
    if (it != objects.end() && *it == object)
      parts[static_cast<std::size_t>(it - objects.begin())].push_back(reach);
  }
  for (std::size_t k = 0; k < objects.size(); ++k) {
    Reach all{0.0F, 0, columns_, 0, rows_, 0};
    for (const Reach& reach : parts[k]) {
      all.column_begin = std::min(all.column_begin, reach.column_begin);
      all.column_end = std::max(all.column_end, reach.column_end);
      all.row_begin = std::min(all.row_begin, reach.row_begin);
      all.row_end = std::max(all.row_end, reach.row_end);
    }
    for (int row = all.row_begin; row < all.row_end; ++row) {
      for (int column = all.column_begin; column < all.column_end; ++column) {
        RayPacket packet = tileRays(view, column, row);
        for (const Reach& reach : parts[k]) {
          tracePrimitive(packet, prepare(view.snapshot.primitives[reach.index], packet.origin), reach.index,
                         0, packet.size);
        }
        for (int i = 0; i < packet.size; ++i) result[k].pixels += packet.hit[i] >= 0;
      }
    }
  }
  return result;
}

}  // namespace atlas::synthetic
