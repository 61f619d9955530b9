// SPDX-License-Identifier: MIT
#include "atlas/lidar/deskew_trial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "atlas/lidar/batched_points.hpp"
#include "atlas/lidar/batching.hpp"
#include "atlas/lidar/per_point.hpp"
#include "atlas/lidar/voxel.hpp"

namespace atlas {
namespace {

constexpr double kThinningLeaf_m = 0.2;  // lidar_aggregator.leaf_size of the published program

struct TimeRange {
  float first_s = std::numeric_limits<float>::max(), last_s = std::numeric_limits<float>::lowest();
};

TimeRange timesOf(const Sweep& sweep) {
  TimeRange range;
  for (const LidarPoint& p : sweep.points) {
    range.first_s = std::min(range.first_s, p.time);
    range.last_s = std::max(range.last_s, p.time);
  }
  return range;
}

void reverseTimes(Sweep& sweep) {
  const TimeRange range = timesOf(sweep);
  for (LidarPoint& p : sweep.points) p.time = range.first_s + range.last_s - p.time;
}

/// Keeps one point per voxel and gives it the time of its place among the voxels sorted by z, y, x, as
/// pcl::VoxelGrid leaves them.
void thinFirst(Sweep& sweep) {
  const TimeRange range = timesOf(sweep);
  std::vector<std::tuple<std::int32_t, std::int32_t, std::int32_t, std::size_t>> kept;
  VoxelIndex index;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    LidarPoint& p = sweep.points[i];
    const auto key = voxelOf(p.x, p.y, p.z, kThinningLeaf_m);
    if (key && index.insert(*key) == kept.size()) {
      kept.emplace_back(key->z, key->y, key->x, i);
    } else {
      p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
    }
  }
  std::sort(kept.begin(), kept.end());
  for (std::size_t rank = 0; rank < kept.size(); ++rank) {
    const auto part = static_cast<float>(rank) / static_cast<float>(kept.size());
    sweep.points[std::get<3>(kept[rank])].time = range.first_s + part * (range.last_s - range.first_s);
  }
}

int batchesOf(DeskewWay way) { return way == DeskewWay::kNone ? 1 : 100; }

}  // namespace

const char* toString(DeskewWay way) {
  switch (way) {
    case DeskewWay::kPerPoint:
      return "per point";
    case DeskewWay::kBatches100:
      return "100 batches";
    case DeskewWay::kNone:
      return "none";
    case DeskewWay::kReversed:
      return "reversed";
    case DeskewWay::kThinnedFirst:
      break;
  }
  return "thinned first";
}

Outcome<std::vector<LidarPoint>> placed(const SweepPtr& sweep, DeskewWay way, const Trajectory& trajectory,
                                        const Pose& T_imu_lidar, Duration stamp_shift) {
  const auto tried = std::make_shared<Sweep>(*sweep);
  tried->stamp += stamp_shift;
  if (way == DeskewWay::kReversed) reverseTimes(*tried);
  if (way == DeskewWay::kThinnedFirst) thinFirst(*tried);
  const Outcome<SweepSpan> span = spanOf(*tried);
  if (!span) return span.reason();
  const bool per_point = way == DeskewWay::kPerPoint || way == DeskewWay::kReversed;
  const Outcome<BatchedSweep> batched =
      per_point ? deskewPerPoint(tried, *span, trajectory, T_imu_lidar)
                : cutIntoBatches(tried, *span, batchesOf(way), trajectory, T_imu_lidar);
  if (!batched) return batched.reason();
  return inMap(*batched).points;
}

Outcome<std::vector<LidarPoint>> placedTogether(const std::vector<SweepPtr>& sweeps, DeskewWay way,
                                                const Trajectory& trajectory, const Pose& T_imu_lidar,
                                                Duration stamp_shift) {
  std::vector<LidarPoint> all;
  for (const SweepPtr& sweep : sweeps) {
    const auto points = placed(sweep, way, trajectory, T_imu_lidar, stamp_shift);
    if (!points) return points.reason();
    all.insert(all.end(), points->begin(), points->end());
  }
  return all;
}

Outcome<MapQuality> qualityOf(const std::vector<SweepPtr>& sweeps, DeskewWay way,
                              const Trajectory& trajectory, const Pose& T_imu_lidar,
                              const MapQualityParams& params, Duration stamp_shift) {
  const auto points = placedTogether(sweeps, way, trajectory, T_imu_lidar, stamp_shift);
  if (!points) return points.reason();
  return mapQuality(*points, params);
}

Outcome<SkewLeft> skewLeftOf(const std::vector<SweepPtr>& sweeps, DeskewWay way, const Trajectory& trajectory,
                             const Pose& T_imu_lidar, const MapQualityParams& params) {
  const auto points = placedTogether(sweeps, way, trajectory, T_imu_lidar);
  const auto skewed = placedTogether(sweeps, DeskewWay::kNone, trajectory, T_imu_lidar);
  const auto right = placedTogether(sweeps, DeskewWay::kPerPoint, trajectory, T_imu_lidar);
  if (!points) return points.reason();
  if (!skewed) return skewed.reason();
  if (!right) return right.reason();
  std::vector<Skew> skews;
  skews.reserve(points->size());
  for (const SweepPtr& sweep : sweeps) {
    const auto sweep_s = static_cast<float>(toSeconds(sweep->stamp - sweeps.front()->stamp));
    for (const LidarPoint& p : sweep->points) {
      const LidarPoint &a = (*right)[skews.size()], &b = (*skewed)[skews.size()];
      skews.push_back({{b.x - a.x, b.y - a.y, b.z - a.z}, sweep_s + p.time});
    }
  }
  return skewLeft(*points, skews, params);
}

}  // namespace atlas
