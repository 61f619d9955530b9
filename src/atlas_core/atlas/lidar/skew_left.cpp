// SPDX-License-Identifier: MIT
#include "atlas/lidar/skew_left.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "atlas/lidar/point_cells.hpp"

namespace atlas {
namespace {

// What counts as plane, as in mapQuality: wide in two directions, thin in the third.
constexpr double kPlaneWidth = 0.2, kPlaneThinness = 0.4;
/// Shifts along the normal that differ by less (RMS) than the range noise of a lidar say nothing.
constexpr double kMinShift_m = 0.02;
/// Along the normal. What skew alone looks like is slower: at most a quarter of a sweep's motion, between
/// seeing a surface ahead and seeing it from the side.
constexpr double kMoving_mps = 0.5;

struct Neighbour {
  Eigen::Vector3d offset;
  Eigen::Vector3d shift;
  double time_s;
};

/// Normal equations of the unknowns: distance = share * shift + time * (drift along the normal + own speed).
/// Share and drift are common to all neighbourhoods, the speed is only asked alone.
struct Equations {
  Eigen::Matrix<double, 5, 5> left = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
};

/// Of one neighbourhood, after the best plane was taken out of both sides (Frisch, Waugh 1933; Lovell 1963).
Equations equationsOf(const std::vector<Neighbour>& neighbours, const Eigen::Matrix3d& axes) {
  const Eigen::Vector3d normal = axes.col(0);
  Eigen::Matrix3d in_plane = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 5> mixed = Eigen::Matrix<double, 3, 5>::Zero();
  Eigen::Vector3d plane_right = Eigen::Vector3d::Zero();
  Equations sums;
  for (const Neighbour& n : neighbours) {
    const Eigen::Vector3d plane(1.0, axes.col(1).dot(n.offset), axes.col(2).dot(n.offset));
    Eigen::Matrix<double, 5, 1> row;
    row << normal.dot(n.shift), n.time_s * normal, n.time_s;
    const double distance_m = normal.dot(n.offset);
    in_plane += plane * plane.transpose();
    mixed += plane * row.transpose();
    plane_right += plane * distance_m;
    sums.left += row * row.transpose();
    sums.right += row * distance_m;
  }
  const Eigen::Matrix<double, 3, 5> explained = in_plane.ldlt().solve(mixed);
  sums.left -= mixed.transpose() * explained;
  sums.right -= explained.transpose() * plane_right;
  return sums;
}

/// Whether the surface itself moves: traffic that drives along is sharp without de-skew, not with it.
bool moves(const Equations& equations) {
  return std::abs(equations.right[4]) > kMoving_mps * equations.left(4, 4);
}

/// Axes of the neighbourhood in order of its extent along them; false when it is no plane.
bool planeAxes(const std::vector<Neighbour>& neighbours, Eigen::Matrix3d& axes) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Neighbour& n : neighbours) mean += n.offset;
  mean /= static_cast<double>(neighbours.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Neighbour& n : neighbours) scatter += (n.offset - mean) * (n.offset - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  const Eigen::Vector3d extents = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  axes = solver.eigenvectors();
  return extents[1] >= kPlaneWidth * extents[2] && extents[0] <= kPlaneThinness * extents[1];
}

}  // namespace

SkewLeft skewLeft(const std::vector<LidarPoint>& points, const std::vector<Skew>& skews,
                  const MapQualityParams& params) {
  validate(params);
  if (skews.size() != points.size()) throw std::invalid_argument("skew left: one skew per point needed");
  const PointCells cells(points, params.radius_m);
  SkewLeft result;
  Equations all;
  std::vector<Neighbour> neighbours;
  for (std::size_t i = 0; i < points.size(); i += params.every) {
    neighbours.clear();
    cells.around(points[i], [&](std::uint32_t index, const Eigen::Vector3d& offset) {
      const Skew& skew = skews[index];
      if (skew.shift_m.allFinite())
        neighbours.push_back({offset, skew.shift_m.cast<double>(), static_cast<double>(skew.time_s)});
    });
    Eigen::Matrix3d axes;
    if (neighbours.size() < params.min_neighbours || !planeAxes(neighbours, axes)) continue;
    const Equations equations = equationsOf(neighbours, axes);
    const auto count = static_cast<double>(neighbours.size());
    if (!(equations.left(0, 0) > kMinShift_m * kMinShift_m * count) || moves(equations)) continue;
    all.left += equations.left;
    all.right += equations.right;
    ++result.neighbourhoods;
  }
  if (result.neighbourhoods > 0)
    result.share = all.left.topLeftCorner<4, 4>().ldlt().solve(all.right.head<4>())[0];
  return result;
}

}  // namespace atlas
