// SPDX-License-Identifier: MIT
// Of BeamModel: what the beams of a layer say by azimuth.
#include <algorithm>
#include <cmath>

#include "atlas/grid/beam_model.hpp"

namespace atlas {
namespace {

constexpr int kAzimuths = polar::kAzimuths;
constexpr float kAzimuthsPerRad = polar::kAzimuthsPerRad;
constexpr double kDefaultSpacing_rad = 0.5 * M_PI / 180.0;  ///< of beams, where a layer has too few to tell
constexpr double kWidestBeam_rad = 2.0 * M_PI / 180.0;
constexpr double kMostBridged_m = 1.5;  ///< of range between two beams on one surface

/// Median step of azimuth between two beams that follow each other.
double spacingOf(const LidarLayer& layer) {
  std::vector<float> steps;
  for (std::size_t i = 1; i < layer.beams.size(); ++i) {
    const double step =
        std::remainder(layer.beams[i].azimuth_rad - layer.beams[i - 1].azimuth_rad, 2.0 * M_PI);
    steps.push_back(static_cast<float>(std::abs(step)));
  }
  if (steps.size() < 8) return kDefaultSpacing_rad;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return std::min<double>(*middle, kWidestBeam_rad);
}

}  // namespace

/// Of the beams of a layer what its bins ask: heights are above the road.
std::vector<BeamModel::Ray> BeamModel::raysOf(const LidarLayer& layer, const Pose& T_map_lidar,
                                              const RoadPlane& road) const {
  const Eigen::Vector3d& origin = T_map_lidar.translation;
  const Eigen::Vector3d up = T_map_lidar.rotation * Eigen::Vector3d::UnitZ();
  const double start = origin.z() - road.heightAt(origin.x(), origin.y());
  std::vector<Ray> rays;
  for (const LayerBeam& beam : layer.beams) {
    Ray ray;
    const double c = std::cos(beam.azimuth_rad), s = std::sin(beam.azimuth_rad);
    ray.bin = (beam.azimuth_rad < 0.0F ? beam.azimuth_rad + 2.0 * M_PI : beam.azimuth_rad) * kAzimuthsPerRad;
    ray.returned = std::isfinite(beam.range_m) && beam.range_m > 0.0F;
    ray.range = ray.returned ? beam.range_m : params_.trusted_m;
    ray.rise = std::tan(layer.elevation_rad) - (up.x() * c + up.y() * s) / up.z() -
               (road.slope.x() * c + road.slope.y() * s);
    if (ray.returned) {
      const double above =
          beam.height_m - road.heightAt(origin.x() + ray.range * c, origin.y() + ray.range * s);
      const double low = 0.5 * params_.min_height_m;
      ray.rise = (above - start) / ray.range;
      if (above <= params_.max_height_m)
        ray.sure = std::clamp((above - low) / (low + 2.0 * params_.slope_sigma * ray.range), 0.0, 1.0);
    }
    rays.push_back(ray);
  }
  return rays;
}

/// Two returns next to each other that go on as the ones before and after them do are of one surface, however
/// flat the beams meet it: between them it is there as well. A step from one thing to another is another step
/// than those along either of them.
void BeamModel::bridge(std::vector<Ray>& rays, double spacing_bins) {
  const auto jump = [&](std::size_t i) { return rays[i + 1].range - rays[i].range; };
  const auto joined = [&](std::size_t i) {
    return rays[i].sure > 0.0 && rays[i + 1].sure > 0.0 && std::abs(jump(i)) <= kMostBridged_m &&
           std::abs(std::remainder(rays[i + 1].bin - rays[i].bin, static_cast<double>(kAzimuths))) <=
               1.6 * spacing_bins;
  };
  for (std::size_t i = 0; i + 1 < rays.size(); ++i) {
    if (!joined(i)) continue;
    const double limit = 0.08 + 0.2 * std::abs(jump(i));
    const bool before = i > 0 && joined(i - 1) && std::abs(jump(i - 1) - jump(i)) <= limit;
    const bool after = i + 2 < rays.size() && joined(i + 1) && std::abs(jump(i + 1) - jump(i)) <= limit;
    if (!before || !after) continue;
    const double step = std::remainder(rays[i + 1].bin - rays[i].bin, static_cast<double>(kAzimuths));
    if (step == 0.0) continue;
    const double per_bin = jump(i) / step;  // the side of each ray towards the other
    (step > 0.0 ? rays[i].slope_up : rays[i].slope_down) = per_bin;
    (step > 0.0 ? rays[i + 1].slope_down : rays[i + 1].slope_up) = per_bin;
  }
}

void BeamModel::fillBins(const LidarLayer& layer, const Pose& T_map_lidar, const RoadPlane& road) {
  for (auto* values :
       {&bins_.seen_to_m, &bins_.start_m, &bins_.rise, &bins_.span_m, &bins_.end_m, &bins_.hit})
    values->assign(kAzimuths, 0.0F);
  const Eigen::Vector3d& origin = T_map_lidar.translation;
  const double start = origin.z() - road.heightAt(origin.x(), origin.y());
  const double spacing_bins = spacingOf(layer) * kAzimuthsPerRad, half = 0.5 * spacing_bins,
               reach = hitReach();
  std::vector<Ray> rays = raysOf(layer, T_map_lidar, road);
  bridge(rays, spacing_bins);
  for (const Ray& ray : rays) {
    const int first = static_cast<int>(std::floor(ray.bin - half)),
              last = static_cast<int>(std::floor(ray.bin + half));
    for (int b = first; b <= last; ++b) {
      const auto bin = static_cast<std::size_t>(polar::wrapped(b));
      const double off = b + 0.5 - ray.bin, slope = off > 0.0 ? ray.slope_up : ray.slope_down;
      const double range = ray.range + off * slope, span = 0.5 * std::abs(slope);
      // A return from the road or from high above says nothing against what is before it, nor for an
      // obstacle.
      const double passed = ray.returned ? range - span - reach : range;
      const bool nearer_hit = ray.sure > 0.0 && (bins_.end_m[bin] == 0.0F || range < bins_.end_m[bin]);
      if (nearer_hit) {
        bins_.end_m[bin] = static_cast<float>(range);
        bins_.hit[bin] = static_cast<float>(ray.sure);
        bins_.span_m[bin] = static_cast<float>(span);
      }
      const bool first_here = bins_.seen_to_m[bin] == 0.0F;
      if (nearer_hit || first_here || (bins_.end_m[bin] == 0.0F && passed < bins_.seen_to_m[bin])) {
        bins_.seen_to_m[bin] = static_cast<float>(std::max(passed, 1e-3));
        bins_.start_m[bin] = static_cast<float>(start);
        bins_.rise[bin] = static_cast<float>(ray.rise);
      }
    }
  }
}

}  // namespace atlas
