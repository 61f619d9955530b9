// SPDX-License-Identifier: MIT
#include "atlas/lidar/line_stage.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "atlas/lidar/batched_points.hpp"
#include "atlas/lidar/ground.hpp"
#include "atlas/lidar/line_split.hpp"

namespace atlas {
namespace {

/// Returns on either side that tell how bright the road is.
constexpr std::size_t kRoadAround = 24;
constexpr std::size_t kMinMarkingPoints = 2;
constexpr double kMarkingSigmas = 5.0;  ///< above the road: rough asphalt glitters

std::vector<std::string> inputNames(const LineParams& params) {
  validate(params);
  std::vector<std::string> names;
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  return names;
}

/// Returns of one laser that lie on one surface, in order of time.
struct Trace {
  bool on_road = false;
  std::uint16_t ring = 0;
  std::vector<Eigen::Vector3d> places;  ///< map
  std::vector<float> intensities;
};

struct Return {
  LidarPoint point;  ///< in map
  double range_m = 0;
};

/// Finite returns within range, by laser, in order of time.
std::map<std::uint16_t, std::vector<Return>> byLaser(const BatchedSweep& batched, double max_range_m) {
  std::map<std::uint16_t, std::vector<Return>> lasers;
  const MapCloud cloud = inMap(batched);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const LidarPoint& seen = batched.sweep->points[i];
    const double range_m = Eigen::Vector3d(seen.x, seen.y, seen.z).norm();
    if (std::isfinite(cloud.points[i].x) && range_m <= max_range_m)
      lasers[seen.ring].push_back({cloud.points[i], range_m});
  }
  for (auto& [ring, returns] : lasers) {
    std::stable_sort(returns.begin(), returns.end(),
                     [](const Return& a, const Return& b) { return a.point.time < b.point.time; });
  }
  return lasers;
}

/// Cuts the returns of a laser where there is a gap or where the road ends.
std::vector<Trace> tracesOf(std::uint16_t ring, const std::vector<Return>& returns, const GroundGrid& ground,
                            const LineParams& params) {
  std::vector<Trace> traces;
  for (const Return& r : returns) {
    const Eigen::Vector3d place(r.point.x, r.point.y, r.point.z);
    const bool on_road =
        std::abs(place.z() - ground.heightAt(place.x(), place.y())) <= params.ground_tolerance_m;
    const double max_gap_m = params.max_gap_m + params.max_gap_per_m * r.range_m;
    if (traces.empty() || traces.back().on_road != on_road ||
        (place - traces.back().places.back()).norm() > max_gap_m) {
      traces.push_back({on_road, ring, {}, {}});
    }
    traces.back().places.push_back(place);
    traces.back().intensities.push_back(r.point.intensity);
  }
  return traces;
}

Line lineOf(const Trace& trace, const ChainLine& piece, LineKind kind) {
  Line line;
  line.kind = kind;
  line.from = piece.from;
  line.to = piece.to;
  line.ring = trace.ring;
  line.points = static_cast<std::uint32_t>(piece.end - piece.first);
  line.rms_m = piece.rms_m;
  double sum = 0;
  for (std::size_t i = piece.first; i < piece.end; ++i) sum += static_cast<double>(trace.intensities[i]);
  line.intensity = sum / static_cast<double>(line.points);
  return line;
}

struct Brightness {
  float median = 0, deviation = 0;  ///< median absolute deviation, as the standard deviation of normal noise
};

float medianOf(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of the road around a return.
Brightness roadAround(const std::vector<float>& intensities, std::size_t i, std::vector<float>& scratch) {
  const std::size_t first = i - std::min(i, kRoadAround);
  const std::size_t end = std::min(intensities.size(), i + kRoadAround + 1);
  scratch.assign(intensities.begin() + static_cast<std::ptrdiff_t>(first),
                 intensities.begin() + static_cast<std::ptrdiff_t>(end));
  Brightness road;
  road.median = medianOf(scratch);
  for (float& value : scratch) value = std::abs(value - road.median);
  road.deviation = 1.4826F * medianOf(scratch);
  return road;
}

/// Where the trace crosses something bright and narrow on the road.
void addMarkings(const Trace& trace, const LineParams& params, std::vector<Line>& lines) {
  const std::size_t count = trace.places.size();
  std::vector<float> scratch;
  const auto is_bright = [&](std::size_t i) {
    const auto intensity = static_cast<double>(trace.intensities[i]);
    const Brightness road = roadAround(trace.intensities, i, scratch);
    const auto median = static_cast<double>(road.median), deviation = static_cast<double>(road.deviation);
    return median > 0.0 && intensity >= params.marking_contrast * median &&
           intensity >= median + kMarkingSigmas * deviation;
  };
  for (std::size_t first = 0; first < count; ++first) {
    if (!is_bright(first)) continue;
    std::size_t end = first + 1;
    while (end < count && is_bright(end)) ++end;
    const Eigen::Vector3d &from = trace.places[first], &to = trace.places[end - 1];
    const bool inside = first > 0 && end < count;  // road on both sides
    if (inside && end - first >= kMinMarkingPoints && (to - from).norm() <= params.max_marking_m)
      lines.push_back(lineOf(trace, {first, end, from, to, 0.0}, LineKind::kMarking));
    first = end;
  }
}

}  // namespace

const char* toString(LineKind kind) {
  switch (kind) {
    case LineKind::kSurface:
      return "surface";
    case LineKind::kRoad:
      return "road";
    case LineKind::kMarking:
      break;
  }
  return "marking";
}

void validate(const LineParams& params) {
  const auto need = [](bool good, const std::string& what, double value) {
    if (!good) throw std::invalid_argument("lines: " + what + ", got " + std::to_string(value));
  };
  if (params.lidars.empty()) throw std::invalid_argument("lines: lidars must name at least one lidar");
  need(params.max_range_m > 0.0 && params.max_range_m <= 200.0, "max_range_m must lie in (0, 200]",
       params.max_range_m);
  need(params.max_gap_m > 0.0, "max_gap_m must be positive", params.max_gap_m);
  need(params.max_gap_per_m >= 0.0, "max_gap_per_m must not be negative", params.max_gap_per_m);
  need(params.min_points >= 3, "min_points must be 3 or more", params.min_points);
  need(params.min_length_m >= 0.0, "min_length_m must not be negative", params.min_length_m);
  need(params.max_rms_m > 0.0, "max_rms_m must be positive", params.max_rms_m);
  need(params.ground_tolerance_m > 0.0, "ground_tolerance_m must be positive", params.ground_tolerance_m);
  need(params.marking_contrast > 1.0, "marking_contrast must exceed 1", params.marking_contrast);
  need(params.max_marking_m > 0.0, "max_marking_m must be positive", params.max_marking_m);
}

LineStage::LineStage(const LineParams& params) : Stage("lines", inputNames(params)), params_(params) {}

void LineStage::push(std::size_t lidar, const BatchedSweepPtr& batches) {
  enqueue(lidar, batches->stamp, [this, lidar, batches] {
    counters_.add("sweeps");
    if (batches->batches.empty()) counters_.skip("sweep", Reason::kNoPoseYet);
    const Lines lines = findLines(*batches, params_);
    counters_.add("lines", lines.lines.size());
    if (on_lines) on_lines(lidar, lines);
  });
}

Lines findLines(const BatchedSweep& batched, const LineParams& params) {
  Lines result;
  result.stamp = batched.stamp;
  result.frame = batched.frame;
  if (batched.batches.empty()) return result;
  const auto lasers = byLaser(batched, params.max_range_m);
  std::vector<LidarPoint> near;
  for (const auto& [ring, returns] : lasers) {
    for (const Return& r : returns) near.push_back(r.point);
  }
  GroundParams ground_params;
  ground_params.radius_m = params.max_range_m;
  ground_params.tolerance_m = params.ground_tolerance_m;
  const GroundGrid ground(near, batched.T_map_lidar.translation, ground_params);
  for (const auto& [ring, returns] : lasers) {
    for (const Trace& trace : tracesOf(ring, returns, ground, params)) {
      for (const ChainLine& piece :
           splitIntoLines(trace.places, static_cast<std::size_t>(params.min_points), params.max_rms_m)) {
        if ((piece.to - piece.from).norm() < params.min_length_m) continue;
        result.lines.push_back(lineOf(trace, piece, trace.on_road ? LineKind::kRoad : LineKind::kSurface));
      }
      if (trace.on_road) addMarkings(trace, params, result.lines);
    }
  }
  return result;
}

}  // namespace atlas
