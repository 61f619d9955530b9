// SPDX-License-Identifier: MIT
// One matrix per batch, one product per point, in double (map coordinates of some kilometres leave a float
// product with errors of millimetres).
#include "atlas/lidar/batched_points.hpp"

#include <limits>

namespace atlas {
namespace {

using Matrix34d = Eigen::Matrix<double, 3, 4>;

Matrix34d matrixOf(const Pose& T) {
  Matrix34d m;
  m.leftCols<3>() = T.rotation.toRotationMatrix();
  m.col(3) = T.translation;
  return m;
}

/// All points by T_target_map * T_map_lidar(batch); NaN where there is no pose. NaN stays NaN.
std::vector<LidarPoint> moved(const BatchedSweep& batched, const Pose& T_target_map) {
  std::vector<LidarPoint> points = batched.sweep->points;
  if (batched.batches.empty()) {
    for (LidarPoint& p : points) p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
    return points;
  }
  std::vector<Matrix34d> T_target_lidar;
  T_target_lidar.reserve(batched.batches.size());
  for (const Batch& batch : batched.batches)
    T_target_lidar.push_back(matrixOf(T_target_map * batch.T_map_lidar));
  forEachPoint(batched, [&](std::size_t i, const Batch& batch) {
    const Matrix34d& m = T_target_lidar[static_cast<std::size_t>(&batch - batched.batches.data())];
    LidarPoint& p = points[i];
    const double x = p.x, y = p.y, z = p.z;
    p.x = static_cast<float>(m(0, 0) * x + m(0, 1) * y + m(0, 2) * z + m(0, 3));
    p.y = static_cast<float>(m(1, 0) * x + m(1, 1) * y + m(1, 2) * z + m(1, 3));
    p.z = static_cast<float>(m(2, 0) * x + m(2, 1) * y + m(2, 2) * z + m(2, 3));
  });
  return points;
}

}  // namespace

Sweep deskewed(const BatchedSweep& batched) {
  return {batched.stamp, batched.frame, moved(batched, batched.T_map_lidar.inverse())};
}

MapCloud inMap(const BatchedSweep& batched) { return {batched.stamp, moved(batched, Pose{})}; }

}  // namespace atlas
