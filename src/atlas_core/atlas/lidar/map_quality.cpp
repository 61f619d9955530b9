// SPDX-License-Identifier: MIT
#include "atlas/lidar/map_quality.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/lidar/point_cells.hpp"

namespace atlas {
namespace {

constexpr double kFloor_m = 1e-3;
// A neighbourhood is plane when it is wide in two directions and thin in the third.
constexpr double kPlaneWidth = 0.2;     // second largest extent, of the largest
constexpr double kPlaneThinness = 0.4;  // smallest extent, of the second largest

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
  const PointCells cells(points, params.radius_m);
  const Eigen::Matrix3d floor = kFloor_m * kFloor_m * Eigen::Matrix3d::Identity();
  MapQuality result;
  double entropy_sum = 0.0;
  std::vector<double> thicknesses_m;
  for (std::size_t i = 0; i < points.size(); i += params.every) {
    Moments moments;
    cells.around(points[i], [&](std::uint32_t, const Eigen::Vector3d& p) { moments.add(p); });
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
