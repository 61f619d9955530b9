// SPDX-License-Identifier: MIT
// All points of a sweep into an image: the chain T_camera_lidar(batch) is multiplied once per batch in
// double, then every point is transformed once, in float (paper IV-E). Depth is z along the optical axis, not
// range.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "atlas/base/geometry.hpp"
#include "atlas/camera/camera_model.hpp"
#include "atlas/camera/compact_sweep.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

/// Where a lidar point is seen.
struct ProjectedPoint {
  float u = 0, v = 0;  ///< px
  float depth_m = 0;   ///< z in the optical frame
};

class Projector {
 public:
  /// Points with depth outside [min_depth_m, max_depth_m] are not seen.
  Projector(const CameraModel& model, double min_depth_m, double max_depth_m);

  /// The point's image; false when it is outside the image, the depth limits or the valid field of the lens,
  /// or NaN.
  [[nodiscard]] bool project(const Eigen::Matrix<float, 3, 4>& T_camera_lidar, const LidarPoint& point,
                             ProjectedPoint& seen) const {
    const auto& m = T_camera_lidar;
    return see(m(0, 0) * point.x + m(0, 1) * point.y + m(0, 2) * point.z + m(0, 3),
               m(1, 0) * point.x + m(1, 1) * point.y + m(1, 2) * point.z + m(1, 3),
               m(2, 0) * point.x + m(2, 1) * point.y + m(2, 2) * point.z + m(2, 3), seen);
  }

  /// False when no point inside the bounds can be seen.
  [[nodiscard]] bool maySee(const Eigen::Matrix<float, 3, 4>& T_camera_lidar,
                            const BatchBounds& bounds) const;

  /// Calls visit(const ProjectedPoint&, const CompactSweep::Batch&) for every point of the sweep that is
  /// seen, batch by batch.
  template <class Visit>
  void projectBatches(const CompactSweep& sweep, const Pose& T_camera_map, Visit&& visit) const {
    Block block;
    for (const CompactSweep::Batch& batch : sweep.batches) {
      const Eigen::Matrix<float, 3, 4> T_camera_lidar = (T_camera_map * batch.T_map_lidar).matrix34f();
      if (!maySee(T_camera_lidar, batch.bounds)) continue;
      for (std::size_t first = batch.first; first < batch.end; first += kBlock) {
        const std::size_t count = std::min(kBlock, batch.end - first);
        seeBlock(sweep, first, count, T_camera_lidar, block);
        for (std::size_t i = 0; i < count; ++i) {
          if (block.seen[i] != 0) visit(ProjectedPoint{block.x[i], block.y[i], block.z[i]}, batch);
        }
      }
    }
  }
  /// The same where the batch does not matter.
  template <class Visit>
  void projectSweep(const CompactSweep& sweep, const Pose& T_camera_map, Visit&& visit) const {
    projectBatches(sweep, T_camera_map,
                   [&](const ProjectedPoint& point, const CompactSweep::Batch&) { visit(point); });
  }

 private:
  static constexpr std::size_t kBlock = 128;  ///< points that are transformed together

  /// From p_camera to its image.
  [[nodiscard]] bool see(float x_camera, float y_camera, float z_camera, ProjectedPoint& seen) const {
    if (!(z_camera >= min_depth_m_ && z_camera <= max_depth_m_)) return false;  // NaN ends here
    if (x_camera < min_x_ * z_camera || x_camera > max_x_ * z_camera) return false;
    if (y_camera < min_y_ * z_camera || y_camera > max_y_ * z_camera) return false;
    float x = x_camera / z_camera;
    float y = y_camera / z_camera;
    if (x * x + y * y > max_tangent_sq_) return false;
    distortion_.apply(x, y);
    seen = {fx_ * x + cx_, fy_ * y + cy_, z_camera};
    return seen.u >= -0.5F && seen.v >= -0.5F && seen.u < right_ && seen.v < bottom_;
  }
  /// The same as see() for many points, written without branches so that the compiler takes several at once:
  /// all are carried through to the pixel, and a mask says which of them count.
  struct Block {
    std::array<float, kBlock> x, y, z;  ///< p_camera, then x and y in px
    std::array<std::int32_t, kBlock> seen;
  };
  void seeBlock(const CompactSweep& sweep, std::size_t first, std::size_t count,
                const Eigen::Matrix<float, 3, 4>& T_camera_lidar, Block& block) const;

  void boundField(const CameraModel& model);

  float fx_, fy_, cx_, cy_;
  float right_, bottom_;
  float min_depth_m_, max_depth_m_;
  float max_tangent_sq_;
  float min_x_, max_x_, min_y_, max_y_;  ///< x/z and y/z outside these are outside the image
  Distortion<float> distortion_;
};

}  // namespace atlas
