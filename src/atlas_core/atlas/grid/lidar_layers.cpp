// SPDX-License-Identifier: MIT
#include "atlas/grid/lidar_layers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace atlas {
namespace {

constexpr std::size_t kMostRings = 1024;
constexpr std::size_t kPointsForElevation = 64;  ///< of a laser: they all have the same
constexpr double kMaxStep_rad = 0.05;            ///< between beams with no return; more, and data is missing
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("grid layers: " + what + ", got " + std::to_string(value));
}

bool isReturn(const LidarPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) &&
         (p.x != 0.0F || p.y != 0.0F || p.z != 0.0F);
}

/// Elevation of each laser, NaN of those without returns.
std::vector<double> elevations(const Sweep& sweep) {
  std::vector<double> sum(kMostRings, 0.0);
  std::vector<std::size_t> count(kMostRings, 0);
  std::size_t rings = 0;
  for (const LidarPoint& p : sweep.points) {
    if (p.ring >= kMostRings || count[p.ring] >= kPointsForElevation || !isReturn(p)) continue;
    sum[p.ring] += std::atan2(static_cast<double>(p.z), std::hypot(p.x, p.y));
    ++count[p.ring];
    rings = std::max(rings, static_cast<std::size_t>(p.ring) + 1);
  }
  sum.resize(rings);
  for (std::size_t ring = 0; ring < rings; ++ring)
    sum[ring] = count[ring] > 0 ? sum[ring] / static_cast<double>(count[ring]) : std::nan("");
  return sum;
}

/// Layer of each ring, -1 = none; `layers` receives them from the lowest up.
std::vector<int> choose(const std::vector<double>& elevation_of_ring, const LayerParams& params,
                        std::vector<LidarLayer>& layers) {
  std::vector<double> asked = params.elevations_rad;
  for (int i = 0; params.elevations_rad.empty() && i < params.count; ++i)
    asked.push_back(params.middle_rad + params.spacing_rad * (i - 0.5 * (params.count - 1)));
  std::sort(asked.begin(), asked.end());
  std::vector<bool> taken(elevation_of_ring.size(), false);
  for (const double elevation : asked) {
    double least = params.max_miss_rad;
    std::size_t best = taken.size();
    for (std::size_t ring = 0; ring < taken.size(); ++ring) {
      const double miss = std::abs(elevation_of_ring[ring] - elevation);
      if (taken[ring] || !(miss <= least) || (best < taken.size() && miss == least)) continue;
      least = miss;
      best = ring;
    }
    if (best < taken.size()) taken[best] = true;
  }
  std::vector<std::size_t> rings;
  for (std::size_t ring = 0; ring < taken.size(); ++ring) {
    if (taken[ring]) rings.push_back(ring);
  }
  std::stable_sort(rings.begin(), rings.end(),
                   [&](std::size_t a, std::size_t b) { return elevation_of_ring[a] < elevation_of_ring[b]; });
  std::vector<int> layer_of_ring(elevation_of_ring.size(), -1);
  for (const std::size_t ring : rings) {
    layer_of_ring[ring] = static_cast<int>(layers.size());
    layers.push_back({elevation_of_ring[ring], {}});
  }
  return layer_of_ring;
}

/// Beams without return between the last beam of the layer and the next one.
void spread(LidarLayer& layer, std::size_t missing, float next_azimuth_rad) {
  if (missing == 0 || layer.beams.empty()) return;
  const double from = layer.beams.back().azimuth_rad,
               turn = std::remainder(next_azimuth_rad - from, 2.0 * M_PI);
  const double step = turn / static_cast<double>(missing + 1);
  if (std::abs(step) > kMaxStep_rad) return;
  for (std::size_t i = 1; i <= missing; ++i) {
    const double azimuth = std::remainder(from + step * static_cast<double>(i), 2.0 * M_PI);
    layer.beams.push_back({static_cast<float>(azimuth), kNan, kNan});
  }
}

}  // namespace

void validate(const LayerParams& p) {
  need(p.elevations_rad.size() <= 128, "elevations_rad must have at most 128 entries",
       static_cast<double>(p.elevations_rad.size()));
  for (const double elevation : p.elevations_rad)
    need(std::abs(elevation) < M_PI / 2.0, "elevations_rad must lie within +-pi/2", elevation);
  need(p.count >= 1 && p.count <= 128, "count must lie in [1, 128]", p.count);
  need(p.spacing_rad > 0.0 && p.spacing_rad < 0.5, "spacing_rad must lie in (0, 0.5)", p.spacing_rad);
  need(std::abs(p.middle_rad) < M_PI / 2.0, "middle_rad must lie within +-pi/2", p.middle_rad);
  need(p.max_miss_rad > 0.0 && p.max_miss_rad < M_PI / 2.0, "max_miss_rad must lie in (0, pi/2)",
       p.max_miss_rad);
}

LidarLayers pickLayers(const BatchedSweep& batched, const LayerParams& params) {
  LidarLayers result;
  result.stamp = batched.stamp;
  result.T_map_lidar = batched.T_map_lidar;
  if (batched.batches.empty()) return result;
  const std::vector<double> elevation_of_ring = elevations(*batched.sweep);
  const std::vector<int> layer_of_ring = choose(elevation_of_ring, params, result.layers);
  std::vector<std::size_t> missing(result.layers.size(), 0);
  const Eigen::Vector3d origin = batched.T_map_lidar.translation;
  forEachPoint(batched, [&](std::size_t i, const Batch& batch) {
    const LidarPoint& p = batched.sweep->points[i];
    const int index = p.ring < layer_of_ring.size() ? layer_of_ring[p.ring] : -1;
    if (index < 0) return;
    LidarLayer& layer = result.layers[static_cast<std::size_t>(index)];
    if (!isReturn(p)) {
      ++missing[static_cast<std::size_t>(index)];
      return;
    }
    const Eigen::Vector3d p_map = batch.T_map_lidar * Eigen::Vector3d(p.x, p.y, p.z);
    const Eigen::Vector3d d = p_map - origin;
    const auto azimuth = static_cast<float>(std::atan2(d.y(), d.x()));
    spread(layer, missing[static_cast<std::size_t>(index)], azimuth);
    missing[static_cast<std::size_t>(index)] = 0;
    layer.beams.push_back(
        {azimuth, static_cast<float>(std::hypot(d.x(), d.y())), static_cast<float>(p_map.z())});
  });
  return result;
}

}  // namespace atlas
