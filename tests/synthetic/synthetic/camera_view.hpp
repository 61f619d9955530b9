// SPDX-License-Identifier: MIT
// What a camera sees, by casting one ray through the centre of every pixel of the distorted image, tile by
// tile: each tile knows the primitives that can reach into it, nearest first, and stops when the rest lies
// behind.
#pragma once

#include <cstdint>
#include <vector>

#include "synthetic/packet.hpp"
#include "synthetic/rig.hpp"
#include "synthetic/scene.hpp"

namespace atlas::synthetic {

constexpr float kSight = 250.0F;  ///< m of z-depth that is drawn
constexpr int kTile = 16;         ///< px

/// One picture before colour. Pixels row by row.
struct View {
  Pose T_city_camera;
  Scene::Snapshot snapshot;
  std::vector<float> depth;       ///< z-depth, m; kSight where nothing was hit
  std::vector<std::int32_t> hit;  ///< primitive of the snapshot or kHit...
};

class CameraView {
 public:
  explicit CameraView(const Camera& camera);
  [[nodiscard]] const Camera& camera() const { return camera_; }
  /// The scene at t_s from T_city_camera (optical frame: x right, y down, z forward).
  [[nodiscard]] View look(const Scene& scene, const Pose& T_city_camera, double t_s) const;

  /// Pixels of an object alone, as if nothing stood before it: how many lie inside the image.
  struct Outline {
    int object = 0;
    int pixels = 0;
  };
  /// For the given objects (sorted), in their order.
  [[nodiscard]] std::vector<Outline> outlines(const View& view, const std::vector<int>& objects) const;

  /// (x/z, y/z) of a pixel.
  [[nodiscard]] Eigen::Vector2f tangent(int pixel) const { return {tangent_x_[pixel], tangent_y_[pixel]}; }

 private:
  struct Interval {
    float low, high;
  };
  struct Reach {
    float nearest;  ///< z-depth, m
    int index;
    int column_begin, column_end, row_begin, row_end;  ///< tiles, end exclusive
  };
  [[nodiscard]] std::vector<Reach> reaches(const View& view) const;
  [[nodiscard]] RayPacket tileRays(const View& view, int column, int row) const;
  [[nodiscard]] int pixelOf(int column, int row, int i) const;

  Camera camera_;
  int columns_, rows_;  ///< tiles
  std::vector<float> tangent_x_, tangent_y_;
  std::vector<Interval> column_bounds_, row_bounds_;  ///< of the tangents in a column or row of tiles
};

}  // namespace atlas::synthetic
