// SPDX-License-Identifier: MIT
#include "atlas/grid/beam_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {

constexpr int kAzimuths = polar::kAzimuths;
constexpr float kAzimuthsPerRad = polar::kAzimuthsPerRad;

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("beam model: " + what + ", got " + std::to_string(value));
}

double logOdds(double p) { return std::log(p / (1.0 - p)); }

/// Evidence of the beams that passed a range, of all azimuths: weight falls with the beam's height.
ATLAS_AVX2_CLONES
void addFree(const float* seen_to, const float* start, const float* rise, int azimuths, float range,
             float top, float per_m, float free, float* sum) {
  for (int a = 0; a < azimuths; ++a) {
    float weight = (top - start[a] - rise[a] * range) * per_m;
    weight = weight < 0.0F ? 0.0F : weight;
    weight = weight > 1.0F ? 1.0F : weight;
    const float says = weight * free;
    sum[a] += range < seen_to[a] ? says : 0.0F;
  }
}

/// Azimuths of a row of cells around the lidar, in bins within [0, kAzimuths]; error below 1e-4 rad. The
/// polynomial of the arc tangent on [0, 1] is that of Abramowitz and Stegun, 4.4.49.
ATLAS_AVX2_CLONES
void polarOf(float x0, float step, float y, int cells, float* azimuth, float* range) {
  constexpr float kHalfPi = static_cast<float>(M_PI / 2.0), kPi = static_cast<float>(M_PI);
  for (int i = 0; i < cells; ++i) {
    const float x = x0 + step * static_cast<float>(i);
    const float ax = x < 0.0F ? -x : x, ay = y < 0.0F ? -y : y;
    const float large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
    const float t = small / (large + 1e-20F), s = t * t;
    float angle =
        ((((-0.0851330F * s + 0.1801410F) * s - 0.3302995F) * s + 0.9998660F) + 0.0208351F * s * s * s * s) *
        t;
    angle = ay > ax ? kHalfPi - angle : angle;
    angle = x < 0.0F ? kPi - angle : angle;
    angle = y < 0.0F ? 2.0F * kPi - angle : angle;
    azimuth[i] = angle * kAzimuthsPerRad;
    range[i] = std::sqrt(x * x + y * y);
  }
}

}  // namespace

void validate(const BeamParams& p) {
  need(p.hit > 0.5 && p.hit < 1.0, "hit must lie in (0.5, 1)", p.hit);
  need(p.free > 0.0 && p.free < 0.5, "free must lie in (0, 0.5)", p.free);
  need(p.range_sigma_m > 0.0 && p.range_sigma_m <= 2.0, "range_sigma_m must lie in (0, 2]", p.range_sigma_m);
  need(p.max_range_m > 0.0 && p.max_range_m <= 500.0, "max_range_m must lie in (0, 500]", p.max_range_m);
  need(p.trusted_m >= 0.0 && p.trusted_m <= p.max_range_m, "trusted_m must lie in [0, max_range_m]",
       p.trusted_m);
  need(p.min_height_m > 0.0, "min_height_m must be positive", p.min_height_m);
  need(p.slope_sigma >= 0.0 && p.slope_sigma <= 0.2, "slope_sigma must lie in [0, 0.2]", p.slope_sigma);
  need(p.max_height_m > p.min_height_m, "max_height_m must exceed min_height_m", p.max_height_m);
  need(p.sure_free_height_m > 0.0 && p.sure_free_height_m < p.max_height_m,
       "sure_free_height_m must lie in (0, max_height_m)", p.sure_free_height_m);
  need(p.layer_weight > 0.0 && p.layer_weight <= 1.0, "layer_weight must lie in (0, 1]", p.layer_weight);
  need(p.min_probability > 0.0 && p.min_probability < 0.5, "min_probability must lie in (0, 0.5)",
       p.min_probability);
  need(p.max_probability > 0.5 && p.max_probability < 1.0, "max_probability must lie in (0.5, 1)",
       p.max_probability);
}

BeamModel::BeamModel(const BeamParams& params) : params_(params) { validate(params); }

const LidarEvidence& BeamModel::evaluate(const LidarLayers& lidar, const RoadPlane& road,
                                         const GridGeometry& geometry, RowWorkers& workers) {
  step_m_ = 0.5 * geometry.cell_m;
  evidence_.occupied.assign(geometry.cells(), 0.5F);
  evidence_.top_m.assign(geometry.cells(), std::numeric_limits<float>::quiet_NaN());
  const Eigen::Vector2d lidar_map = lidar.T_map_lidar.translation.head<2>();
  const Eigen::Vector2d size(geometry.columns * geometry.cell_m, geometry.rows * geometry.cell_m);
  const Eigen::Vector2d low = (geometry.corner() - lidar_map).cwiseAbs(),
                        high = (geometry.corner() + size - lidar_map).cwiseAbs();
  const double farthest = std::min(low.cwiseMax(high).norm(), params_.max_range_m);
  const int ranges = static_cast<int>(farthest / step_m_) + 1;
  log_odds_.assign(static_cast<std::size_t>(ranges) * kAzimuths, 0.0F);
  for (const LidarLayer& layer : lidar.layers) {
    if (layer.beams.empty()) continue;
    fillBins(layer, lidar.T_map_lidar, road);
    addPassed(ranges, workers);
    addHits(ranges);
  }
  workers.run(geometry.rows, [&](int first, int end) {
    for (int row = first; row < end; ++row) gather(row, geometry, lidar_map, ranges);
  });
  noteTops(lidar, road, geometry);
  return evidence_;
}

double BeamModel::rangeSigma() const {
  return std::hypot(params_.range_sigma_m, 2.0 * step_m_ / std::sqrt(12.0));
}

double BeamModel::hitReach() const { return std::max(step_m_, 2.0 * rangeSigma()); }

void BeamModel::addPassed(int ranges, RowWorkers& workers) {
  const auto top = static_cast<float>(params_.max_height_m);
  const auto per_m = static_cast<float>(1.0 / (params_.max_height_m - params_.sure_free_height_m));
  const auto sent = [](float seen_to) { return seen_to > 0.0F; };
  const auto from =
      std::find_if(bins_.seen_to_m.begin(), bins_.seen_to_m.end(), sent) - bins_.seen_to_m.begin();
  const auto to = kAzimuths - (std::find_if(bins_.seen_to_m.rbegin(), bins_.seen_to_m.rend(), sent) -
                               bins_.seen_to_m.rbegin());
  const float farthest = *std::max_element(bins_.seen_to_m.begin(), bins_.seen_to_m.end());
  const int reached = std::min(ranges, static_cast<int>(farthest / step_m_) + 1);
  workers.run(reached, [&](int first, int end) {
    for (int r = first; r < end; ++r) {
      const double range = r * step_m_;
      const double p = 0.5 - (0.5 - params_.free) * (1.0 - range / params_.max_range_m);
      const auto free = static_cast<float>(params_.layer_weight * logOdds(std::min(p, 0.5)));
      addFree(bins_.seen_to_m.data() + from, bins_.start_m.data() + from, bins_.rise.data() + from,
              static_cast<int>(to - from), static_cast<float>(range), top, per_m, free,
              log_odds_.data() + static_cast<std::ptrdiff_t>(r) * kAzimuths + from);
    }
  });
}

void BeamModel::addHits(int ranges) {
  const double sigma = rangeSigma(), reach = hitReach();
  std::vector<float> by_cm;  // log-odds by distance from the hit
  for (int cm = 0; cm <= static_cast<int>(reach * 100.0) + 1; ++cm) {
    const double off = 0.01 * cm / sigma;
    by_cm.push_back(static_cast<float>(params_.layer_weight *
                                       logOdds(0.5 + (params_.hit - 0.5) * std::exp(-0.5 * off * off))));
  }
  for (int a = 0; a < kAzimuths; ++a) {
    if (bins_.hit[a] <= 0.0F) continue;
    const double z = bins_.end_m[a], span = bins_.span_m[a];
    const int first = std::max(0, static_cast<int>(std::ceil((z - span - reach) / step_m_)));
    const int last = std::min(ranges - 1, static_cast<int>(std::floor((z + span + reach) / step_m_)));
    for (int r = first; r <= last; ++r) {
      log_odds_[static_cast<std::size_t>(r) * kAzimuths + static_cast<std::size_t>(a)] +=
          by_cm[static_cast<std::size_t>(std::max(0.0, std::abs(r * step_m_ - z) - span) * 100.0 + 0.5)] *
          bins_.hit[a];
    }
  }
}

void BeamModel::gather(int row, const GridGeometry& geometry, const Eigen::Vector2d& lidar_map, int ranges) {
  const std::size_t first = geometry.indexOf(0, row);
  const Eigen::Vector2d start = geometry.middleOf(0, row) - lidar_map;
  std::vector<float> azimuth(geometry.columns), range(geometry.columns);
  polarOf(static_cast<float>(start.x()), static_cast<float>(geometry.cell_m), static_cast<float>(start.y()),
          geometry.columns, azimuth.data(), range.data());
  const auto per_step = static_cast<float>(1.0 / step_m_);
  const auto half_cell = static_cast<float>(0.5 * geometry.cell_m * kAzimuthsPerRad);
  const auto most = static_cast<float>(logOdds(params_.max_probability)),
             least = static_cast<float>(logOdds(params_.min_probability));
  for (int column = 0; column < geometry.columns; ++column) {
    const int r = static_cast<int>(range[column] * per_step + 0.5F);
    if (r >= ranges || r == 0) continue;
    const float half = std::min(half_cell / range[column], 0.25F * kAzimuths);
    const int from = static_cast<int>(std::floor(azimuth[column] - half)),
              to = static_cast<int>(std::floor(azimuth[column] + half));
    const float* polar = log_odds_.data() + static_cast<std::ptrdiff_t>(r) * kAzimuths;
    float sum = 0.0F, strongest = 0.0F;
    for (int bin = from; bin <= to; ++bin) {
      const float value = polar[polar::wrapped(bin)];
      sum += value;
      strongest = std::max(strongest, value);
    }
    const float value = strongest > 0.0F ? strongest : sum / static_cast<float>(to - from + 1);
    if (value == 0.0F) continue;
    evidence_.occupied[first + static_cast<std::size_t>(column)] =
        1.0F / (1.0F + std::exp(-std::clamp(value, least, most)));
  }
}

void BeamModel::noteTops(const LidarLayers& lidar, const RoadPlane& road, const GridGeometry& geometry) {
  const Eigen::Vector3d& origin = lidar.T_map_lidar.translation;
  for (const LidarLayer& layer : lidar.layers) {
    for (const LayerBeam& beam : layer.beams) {
      if (!std::isfinite(beam.range_m)) continue;
      const double x = origin.x() + beam.range_m * std::cos(beam.azimuth_rad),
                   y = origin.y() + beam.range_m * std::sin(beam.azimuth_rad);
      const int column = geometry.columnOf(x), row = geometry.rowOf(y);
      const double above = beam.height_m - road.heightAt(x, y);
      if (!geometry.contains(column, row) || above > params_.max_height_m) continue;
      float& top = evidence_.top_m[geometry.indexOf(column, row)];
      if (!(above <= top)) top = static_cast<float>(above);  // NaN gives way
    }
  }
}

}  // namespace atlas
