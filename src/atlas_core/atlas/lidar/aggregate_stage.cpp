// SPDX-License-Identifier: MIT
#include "atlas/lidar/aggregate_stage.hpp"

#include <cmath>
#include <stdexcept>

#include "atlas/lidar/batched_points.hpp"
#include "atlas/lidar/voxel.hpp"

namespace atlas {
namespace {

std::vector<std::string> inputNames(const AggregateParams& params) {
  validate(params);
  std::vector<std::string> names;
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  return names;
}

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("aggregate: " + what + ", got " + std::to_string(value));
}

/// The first multiple of the period at or after the stamp.
Stamp endOfPeriod(Stamp stamp, Duration period) {
  const Stamp rest = ((stamp % period) + period) % period;  // never negative, before the epoch neither
  return rest == 0 ? stamp : stamp + (period - rest);
}

}  // namespace

void validate(const AggregateParams& params) {
  if (params.lidars.empty()) throw std::invalid_argument("aggregate: lidars must name at least one lidar");
  need(params.window_s > 0.0 && params.window_s <= 3600.0, "window_s must lie in (0, 3600]", params.window_s);
  need(params.period_s >= 1e-3 && params.period_s <= 3600.0, "period_s must lie in [0.001, 3600]",
       params.period_s);
  need(params.voxel_m >= 0.0 && std::isfinite(params.voxel_m), "voxel_m must not be negative",
       params.voxel_m);
}

AggregateStage::AggregateStage(const AggregateParams& params)
    : Stage("aggregate", inputNames(params)),
      params_(params),
      period_(fromSeconds(params.period_s)),
      window_(fromSeconds(params.window_s)) {}

void AggregateStage::push(std::size_t lidar, const BatchedSweepPtr& batches) {
  enqueue(lidar, batches->stamp, [this, batches] { take(batches); });
}

void AggregateStage::take(const BatchedSweepPtr& batches) {
  emitDue(batches->stamp - 1);
  counters_.add("sweeps");
  if (batches->batches.empty()) {
    counters_.add("sweeps without pose");
    return;
  }
  window_.push(batches);
  next_cloud_ = endOfPeriod(batches->stamp, period_);
  window_.forget(batches->stamp);
}

void AggregateStage::emitDue(Stamp known) {
  if (!next_cloud_ || known < *next_cloud_) return;
  const Stamp stamp = *next_cloud_;
  next_cloud_.reset();
  window_.forget(stamp);
  counters_.add("clouds");
  if (on_cloud) on_cloud(std::make_shared<MapCloud>(aggregate(window_.sweeps(), stamp, params_.voxel_m)));
}

void AggregateStage::onProgress() { emitDue(merge().watermark()); }

void AggregateStage::onEnd() { emitDue(kEndOfTime); }

MapCloud aggregate(const std::deque<BatchedSweepPtr>& sweeps, Stamp stamp, double voxel_m) {
  MapCloud result;
  result.stamp = stamp;
  std::optional<VoxelFilter> filter;
  std::size_t points = 0;
  for (const BatchedSweepPtr& sweep : sweeps) points += sweep->sweep->points.size();
  if (voxel_m > 0.0) filter.emplace(voxel_m, VoxelPoint::kFirst, points / 8);
  for (const BatchedSweepPtr& sweep : sweeps) {
    const auto offset_s = static_cast<float>(toSeconds(sweep->stamp - stamp));
    const MapCloud cloud = inMap(*sweep);
    for (LidarPoint point : cloud.points) {
      point.time += offset_s;
      if (filter) {
        filter->add(point);
      } else if (std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z)) {
        result.points.push_back(point);
      }
    }
  }
  if (filter) result.points = filter->take();
  return result;
}

}  // namespace atlas
