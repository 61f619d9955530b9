// SPDX-License-Identifier: MIT
#include "synthetic/rigid_fit.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace atlas::synthetic {
namespace {

constexpr int kRounds = 3;
constexpr double kGate = 3.0 * 1.4826;   // residuals are compared with their median: 1.4826 of it is sigma
constexpr double kFewestSigma_m = 1e-4;  // float rounding of map coordinates; perfect pairs stay in

/// Fit over the pairs with a residual under `T` up to `limit_m`.
std::optional<Pose> fit(const std::vector<PointPair>& pairs, const Pose& T, double limit_m) {
  const auto isUsed = [&](const PointPair& pair) {
    return (T * pair.first.cast<double>() - pair.second.cast<double>()).norm() <= limit_m;
  };
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const PointPair& pair : pairs) {
    if (!isUsed(pair)) continue;
    from += pair.first.cast<double>();
    to += pair.second.cast<double>();
    ++count;
  }
  if (count < 3) return std::nullopt;
  from /= static_cast<double>(count);
  to /= static_cast<double>(count);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const PointPair& pair : pairs) {
    if (isUsed(pair))
      covariance += (pair.second.cast<double>() - to) * (pair.first.cast<double>() - from).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[1] <= 1e-9 * svd.singularValues()[0]) return std::nullopt;  // all on one line
  Eigen::Matrix3d reflection = Eigen::Matrix3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) reflection(2, 2) = -1.0;
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(svd.matrixU() * reflection * svd.matrixV().transpose()));
  return Pose{rotation.normalized(), to - rotation.normalized() * from};
}

double medianResidual(const std::vector<PointPair>& pairs, const Pose& T) {
  std::vector<double> residuals;
  residuals.reserve(pairs.size());
  for (const PointPair& pair : pairs)
    residuals.push_back((T * pair.first.cast<double>() - pair.second.cast<double>()).norm());
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return *middle;
}

}  // namespace

std::optional<Pose> rigidFit(const std::vector<PointPair>& pairs) {
  std::optional<Pose> T = fit(pairs, {}, std::numeric_limits<double>::infinity());
  for (int round = 1; T && round < kRounds; ++round)
    T = fit(pairs, *T, std::max(kGate * medianResidual(pairs, *T), 3.0 * kFewestSigma_m));
  return T;
}

}  // namespace atlas::synthetic
