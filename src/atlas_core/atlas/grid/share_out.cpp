// SPDX-License-Identifier: MIT
#include "atlas/grid/share_out.hpp"

#include <limits>

namespace atlas {
namespace {

constexpr int kMostRounds = 10;
constexpr double kPosition_m = 0.5;  ///< a difference of this counts as much as one of kVelocity_mps
constexpr double kVelocity_mps = 1.5;

double distanceSq(const ClusterCell& cell, const Eigen::Vector4d& mean) {
  const double velocity_sq = kVelocity_mps * kVelocity_mps + cell.variance;
  return (cell.position - mean.head<2>()).squaredNorm() / (kPosition_m * kPosition_m) +
         (cell.velocity - mean.tail<2>()).squaredNorm() / velocity_sq;
}

}  // namespace

std::vector<std::size_t> shareOut(const Cluster& cells, std::vector<Eigen::Vector4d> seeds) {
  std::vector<std::size_t> owner(cells.size(), seeds.size());
  for (int round = 0; round < kMostRounds; ++round) {
    bool changed = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      double least = std::numeric_limits<double>::infinity();
      std::size_t best = 0;
      for (std::size_t k = 0; k < seeds.size(); ++k) {
        const double distance = distanceSq(cells[i], seeds[k]);
        if (distance < least) {
          least = distance;
          best = k;
        }
      }
      changed = changed || owner[i] != best;
      owner[i] = best;
    }
    if (!changed) break;
    std::vector<Eigen::Vector4d> sums(seeds.size(), Eigen::Vector4d::Zero());
    std::vector<double> weights(seeds.size(), 0.0);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      Eigen::Vector4d at;
      at << cells[i].position, cells[i].velocity;
      sums[owner[i]] += cells[i].weight * at;
      weights[owner[i]] += cells[i].weight;
    }
    for (std::size_t k = 0; k < seeds.size(); ++k) {
      if (weights[k] > 0.0) seeds[k] = sums[k] / weights[k];
    }
  }
  return owner;
}

}  // namespace atlas
