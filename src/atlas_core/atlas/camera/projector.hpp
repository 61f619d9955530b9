// SPDX-License-Identifier: MIT
// All points of a sweep into an image: the chain T_camera_lidar(batch) is multiplied once per batch in
// double, then every point is transformed once, in float (paper IV-E). Depth is z along the optical axis, not
// range.
#pragma once

#include <cstddef>
#include <vector>

#include "atlas/base/geometry.hpp"
#include "atlas/camera/batch_bounds.hpp"
#include "atlas/camera/camera_model.hpp"
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
    const float z = m(2, 0) * point.x + m(2, 1) * point.y + m(2, 2) * point.z + m(2, 3);
    if (!(z >= min_depth_m_ && z <= max_depth_m_)) return false;  // NaN ends here
    const float x_z = m(0, 0) * point.x + m(0, 1) * point.y + m(0, 2) * point.z + m(0, 3);
    if (x_z < min_x_ * z || x_z > max_x_ * z) return false;
    const float y_z = m(1, 0) * point.x + m(1, 1) * point.y + m(1, 2) * point.z + m(1, 3);
    if (y_z < min_y_ * z || y_z > max_y_ * z) return false;
    float x = x_z / z;
    float y = y_z / z;
    if (x * x + y * y > max_tangent_sq_) return false;
    distortion_.apply(x, y);
    seen = {fx_ * x + cx_, fy_ * y + cy_, z};
    return seen.u >= -0.5F && seen.v >= -0.5F && seen.u < right_ && seen.v < bottom_;
  }

  /// False when no point inside the bounds can be seen.
  [[nodiscard]] bool maySee(const Eigen::Matrix<float, 3, 4>& T_camera_lidar,
                            const BatchBounds& bounds) const;

  /// Calls visit(const ProjectedPoint&) for every point of the sweep that is seen, in the sweep's order.
  template <class Visit>
  void projectSweep(const BoundedSweep& bounded, const Pose& T_camera_map, Visit&& visit) const {
    const BatchedSweep& sweep = *bounded.batched;
    std::vector<Eigen::Matrix<float, 3, 4>> T_camera_lidar;  // of each batch
    std::vector<bool> in_view;
    for (std::size_t b = 0; b < sweep.batches.size(); ++b) {
      T_camera_lidar.push_back((T_camera_map * sweep.batches[b].T_map_lidar).matrix34f());
      in_view.push_back(maySee(T_camera_lidar[b], bounded.bounds[b]));
    }
    const LidarPoint* points = sweep.sweep->points.data();
    ProjectedPoint seen;
    if (sweep.batch_of_point.empty()) {
      for (std::size_t b = 0; b < sweep.batches.size(); ++b) {
        const std::size_t end = in_view[b] ? sweep.batches[b].first + sweep.batches[b].count : 0;
        for (std::size_t i = sweep.batches[b].first; i < end; ++i) {
          if (project(T_camera_lidar[b], points[i], seen)) visit(seen);
        }
      }
      return;
    }
    for (std::size_t i = 0; i < sweep.batch_of_point.size(); ++i) {
      const std::size_t b = sweep.batch_of_point[i];
      if (in_view[b] && project(T_camera_lidar[b], points[i], seen)) visit(seen);
    }
  }

 private:
  void boundField(const CameraModel& model);

  float fx_, fy_, cx_, cy_;
  float right_, bottom_;
  float min_depth_m_, max_depth_m_;
  float max_tangent_sq_;
  float min_x_, max_x_, min_y_, max_y_;  ///< x/z and y/z outside these are outside the image
  Distortion<float> distortion_;
};

}  // namespace atlas
