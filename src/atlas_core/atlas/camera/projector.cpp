// SPDX-License-Identifier: MIT
#include "atlas/camera/projector.hpp"

#include <algorithm>

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {
constexpr int kBorderSteps = 64;        // bearings taken along each side of the image
constexpr double kBorderMargin = 0.01;  // what a side may bow out between two of them, and float rounding
constexpr float kRounding_m = 0.01F;    // far above what float arithmetic loses on a few hundred metres
}  // namespace

Projector::Projector(const CameraModel& model, double min_depth_m, double max_depth_m)
    : fx_(static_cast<float>(model.fx())),
      fy_(static_cast<float>(model.fy())),
      cx_(static_cast<float>(model.cx())),
      cy_(static_cast<float>(model.cy())),
      right_(static_cast<float>(model.width()) - 0.5F),
      bottom_(static_cast<float>(model.height()) - 0.5F),
      min_depth_m_(static_cast<float>(min_depth_m)),
      max_depth_m_(static_cast<float>(max_depth_m)),
      max_tangent_sq_(static_cast<float>(model.maxTangent() * model.maxTangent())),
      distortion_(model.distortion().cast<float>()) {
  boundField(model);
}

// The conditions of project() are linear in p while x and y are not yet divided by z, so each is a
// half-space: when even the best point of the bounds misses one, none is seen.
bool Projector::maySee(const Eigen::Matrix<float, 3, 4>& T_camera_lidar, const BatchBounds& bounds) const {
  if (bounds.empty()) return false;
  const auto reaches = [&](const Eigen::RowVector4f& side, float at_least) {
    return bounds.largest(side.head<3>(), side(3)) >= at_least - kRounding_m;
  };
  const Eigen::RowVector4f x = T_camera_lidar.row(0), y = T_camera_lidar.row(1), z = T_camera_lidar.row(2);
  return reaches(z, min_depth_m_) && reaches(-z, -max_depth_m_) &&          //
         reaches(x - min_x_ * z, 0.0F) && reaches(max_x_ * z - x, 0.0F) &&  //
         reaches(y - min_y_ * z, 0.0F) && reaches(max_y_ * z - y, 0.0F);
}

void Projector::boundField(const CameraModel& model) {
  Eigen::Vector2d low(0.0, 0.0), high(0.0, 0.0);
  bool known = true;
  const auto take = [&](double u, double v) {
    const auto bearing = model.bearing({u, v});
    known = known && bearing.has_value();
    if (!bearing) return;
    low = low.cwiseMin(bearing->head<2>());
    high = high.cwiseMax(bearing->head<2>());
  };
  for (int i = 0; i <= kBorderSteps; ++i) {
    const double u = -0.5 + model.width() * static_cast<double>(i) / kBorderSteps;
    const double v = -0.5 + model.height() * static_cast<double>(i) / kBorderSteps;
    take(u, -0.5);
    take(u, model.height() - 0.5);
    take(-0.5, v);
    take(model.width() - 0.5, v);
  }
  const double limit = model.maxTangent();
  if (!known) {  // the image is larger than what the lens shows
    low.setConstant(-limit);
    high.setConstant(limit);
  }
  min_x_ = static_cast<float>(std::max(-limit, low.x() - kBorderMargin));
  max_x_ = static_cast<float>(std::min(limit, high.x() + kBorderMargin));
  min_y_ = static_cast<float>(std::max(-limit, low.y() - kBorderMargin));
  max_y_ = static_cast<float>(std::min(limit, high.y() + kBorderMargin));
}

ATLAS_AVX2_CLONES
void Projector::seeBlock(const CompactSweep& sweep, std::size_t first, std::size_t count,
                         const Eigen::Matrix<float, 3, 4>& T_camera_lidar, Block& block) const {
  const float *x = &sweep.x[first], *y = &sweep.y[first], *z = &sweep.z[first];
  const Eigen::Matrix<float, 3, 4> m = T_camera_lidar;  // by value: the stores below cannot change it
  for (std::size_t i = 0; i < count; ++i) {
    block.x[i] = m(0, 0) * x[i] + m(0, 1) * y[i] + m(0, 2) * z[i] + m(0, 3);
    block.y[i] = m(1, 0) * x[i] + m(1, 1) * y[i] + m(1, 2) * z[i] + m(1, 3);
    block.z[i] = m(2, 0) * x[i] + m(2, 1) * y[i] + m(2, 2) * z[i] + m(2, 3);
  }
  const Projector p = *this;  // the same
  for (std::size_t i = 0; i < count; ++i) {
    const float z_camera = block.z[i], x_over_z = block.x[i] / z_camera, y_over_z = block.y[i] / z_camera;
    block.seen[i] = static_cast<std::int32_t>(z_camera >= p.min_depth_m_) &
                    static_cast<std::int32_t>(z_camera <= p.max_depth_m_) &
                    static_cast<std::int32_t>(block.x[i] >= p.min_x_ * z_camera) &
                    static_cast<std::int32_t>(block.x[i] <= p.max_x_ * z_camera) &
                    static_cast<std::int32_t>(block.y[i] >= p.min_y_ * z_camera) &
                    static_cast<std::int32_t>(block.y[i] <= p.max_y_ * z_camera) &
                    static_cast<std::int32_t>(x_over_z * x_over_z + y_over_z * y_over_z <= p.max_tangent_sq_);
    block.x[i] = x_over_z;
    block.y[i] = y_over_z;
  }
  p.distortion_.applyAll(block.x.data(), block.y.data(), count);
  for (std::size_t i = 0; i < count; ++i) {
    block.x[i] = p.fx_ * block.x[i] + p.cx_;
    block.y[i] = p.fy_ * block.y[i] + p.cy_;
    block.seen[i] &=
        static_cast<std::int32_t>(block.x[i] >= -0.5F) & static_cast<std::int32_t>(block.y[i] >= -0.5F) &
        static_cast<std::int32_t>(block.x[i] < p.right_) & static_cast<std::int32_t>(block.y[i] < p.bottom_);
  }
}

}  // namespace atlas
