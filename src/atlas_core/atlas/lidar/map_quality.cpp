// SPDX-License-Identifier: MIT
#include "atlas/lidar/map_quality.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/lidar/voxel.hpp"

namespace atlas {
namespace {

constexpr double kFloor_m = 1e-3;
// A neighbourhood is plane when it is wide in two directions and thin in the third.
constexpr double kPlaneWidth = 0.2;     // second largest extent, of the largest
constexpr double kPlaneThinness = 0.4;  // smallest extent, of the second largest

Eigen::Vector3d positionOf(const LidarPoint& p) { return {p.x, p.y, p.z}; }

/// Points sorted into cells as large as the radius, so that neighbours lie in 27 of them.
class Cells {
 public:
  Cells(const std::vector<LidarPoint>& points, double edge_m) : points_(points), edge_m_(edge_m) {
    std::vector<std::uint32_t> cell_of(points.size(), VoxelIndex::kNone);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto key = voxelOf(points[i].x, points[i].y, points[i].z, edge_m);
      if (key) cell_of[i] = index_.insert(*key);
    }
    begin_.assign(index_.size() + 1, 0);
    for (const std::uint32_t cell : cell_of)
      begin_[cell == VoxelIndex::kNone ? 0 : cell + 1] += cell != VoxelIndex::kNone;
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    members_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (cell_of[i] != VoxelIndex::kNone) members_[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
    }
  }

  /// Calls visit(position - center) for every point within the radius, itself included.
  template <class Visit>
  void around(const LidarPoint& center, Visit&& visit) const {
    const auto key = voxelOf(center.x, center.y, center.z, edge_m_);
    if (!key) return;
    const Eigen::Vector3d middle = positionOf(center);
    for (int cell = 0; cell < 27; ++cell) {
      const std::uint32_t number =
          index_.find({key->x + cell / 9 - 1, key->y + cell / 3 % 3 - 1, key->z + cell % 3 - 1});
      if (number == VoxelIndex::kNone) continue;
      for (std::size_t i = begin_[number]; i < begin_[number + 1]; ++i) {
        const Eigen::Vector3d offset = positionOf(points_[members_[i]]) - middle;
        if (offset.squaredNorm() <= edge_m_ * edge_m_) visit(offset);
      }
    }
  }

 private:
  const std::vector<LidarPoint>& points_;
  double edge_m_;
  VoxelIndex index_;
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> members_;  ///< by cell, in the order of the points
};

/// Sums of a neighbourhood.
struct Moments {
  double count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& p) {
    count += 1;
    sum += p;
    products += p * p.transpose();
  }
  [[nodiscard]] Eigen::Matrix3d scatter() const { return products - sum * sum.transpose() / count; }
};

/// RMS distance to the best plane, with the three degrees of freedom that the plane has taken; negative when
/// the neighbourhood is none.
double thickness(const Moments& moments) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.scatter(), Eigen::EigenvaluesOnly);
  const Eigen::Vector3d extents = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (extents[1] < kPlaneWidth * extents[2] || extents[0] > kPlaneThinness * extents[1]) return -1.0;
  return extents[0] / std::sqrt(moments.count - 3.0);
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void validate(const MapQualityParams& params) {
  const auto need = [](bool good, const std::string& what) {
    if (!good) throw std::invalid_argument("map quality: " + what);
  };
  need(params.radius_m > 0.0 && std::isfinite(params.radius_m),
       "radius_m must be positive, got " + std::to_string(params.radius_m));
  need(params.min_neighbours >= 5,
       "min_neighbours must be 5 or more, got " + std::to_string(params.min_neighbours));
  need(params.every >= 1, "every must be 1 or more, got 0");
}

MapQuality mapQuality(const std::vector<LidarPoint>& points, const MapQualityParams& params) {
  validate(params);
  const Cells cells(points, params.radius_m);
  const Eigen::Matrix3d floor = kFloor_m * kFloor_m * Eigen::Matrix3d::Identity();
  MapQuality result;
  double entropy_sum = 0.0;
  std::vector<double> thicknesses_m;
  for (std::size_t i = 0; i < points.size(); i += params.every) {
    Moments moments;
    cells.around(points[i], [&](const Eigen::Vector3d& p) { moments.add(p); });
    if (moments.count < static_cast<double>(params.min_neighbours)) continue;
    const Eigen::Matrix3d covariance = moments.scatter() / (moments.count - 1.0) + floor;
    entropy_sum += 0.5 * (3.0 * std::log(2.0 * M_PI * M_E) + std::log(covariance.determinant()));
    ++result.neighbourhoods;
    const double thickness_m = thickness(moments);
    if (thickness_m >= 0.0) thicknesses_m.push_back(thickness_m);
  }
  if (result.neighbourhoods == 0) return result;
  result.mean_entropy = entropy_sum / static_cast<double>(result.neighbourhoods);
  result.planes = thicknesses_m.size();
  result.plane_thickness_m = median(thicknesses_m);
  return result;
}

}  // namespace atlas
