// SPDX-License-Identifier: MIT
#include "atlas/lidar/batching.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {
namespace {

/// The points of one batch, before it has a pose.
struct Group {
  std::uint32_t first = 0, count = 0;
  double time_sum_s = 0;  ///< relative to the sweep's stamp
};

/// Group i holds the points [i n / N, (i + 1) n / N): sizes differ by one point at most.
std::vector<Group> groupsInOrder(const std::vector<LidarPoint>& points, std::size_t batches) {
  const std::size_t groups = std::min(batches, points.size());
  std::vector<Group> result(groups);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < groups; ++i) {
    const std::size_t end = (i + 1) * points.size() / groups;
    result[i].first = static_cast<std::uint32_t>(begin);
    result[i].count = static_cast<std::uint32_t>(end - begin);
    for (; begin < end; ++begin) result[i].time_sum_s += static_cast<double>(points[begin].time);
  }
  return result;
}

/// Groups of equal duration over the points' times; the empty ones are left out. Fills the group of each
/// point.
std::vector<Group> groupsByTime(const std::vector<LidarPoint>& points, std::size_t batches,
                                std::vector<std::uint16_t>& group_of_point) {
  const auto [oldest, newest] = std::minmax_element(
      points.begin(), points.end(), [](const LidarPoint& a, const LidarPoint& b) { return a.time < b.time; });
  const double begin_s = oldest->time;
  const double per_s = static_cast<double>(batches) / (static_cast<double>(newest->time) - begin_s);
  std::vector<Group> bins(batches);
  group_of_point.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double time_s = points[i].time;
    const std::size_t bin = std::min(batches - 1, static_cast<std::size_t>((time_s - begin_s) * per_s));
    group_of_point[i] = static_cast<std::uint16_t>(bin);
    ++bins[bin].count;
    bins[bin].time_sum_s += time_s;
  }
  std::vector<std::uint16_t> place(batches, 0);
  std::vector<Group> result;
  for (std::size_t bin = 0; bin < batches; ++bin) {
    if (bins[bin].count == 0) continue;
    place[bin] = static_cast<std::uint16_t>(result.size());
    result.push_back(bins[bin]);
  }
  for (std::uint16_t& group : group_of_point) group = place[group];
  return result;
}

}  // namespace

Outcome<SweepSpan> spanOf(const Sweep& sweep) {
  if (sweep.points.empty()) return Reason::kEmpty;
  float first_s = 0.0F, last_s = 0.0F;  // the stamp itself is part of the span
  float previous_s = sweep.points.front().time;
  SweepSpan span;
  for (const LidarPoint& point : sweep.points) {
    if (!(std::abs(point.time) <= static_cast<float>(kMaxPointTime_s))) return Reason::kNotFinite;
    first_s = std::min(first_s, point.time);
    last_s = std::max(last_s, point.time);
    span.time_ordered = span.time_ordered && point.time >= previous_s;
    previous_s = point.time;
  }
  span.first = sweep.stamp + fromSeconds(static_cast<double>(first_s));
  span.last = sweep.stamp + fromSeconds(static_cast<double>(last_s));
  return span;
}

Outcome<BatchedSweep> cutIntoBatches(const SweepPtr& sweep, const SweepSpan& span, int batches,
                                     const Trajectory& trajectory, const Pose& T_imu_lidar) {
  const Outcome<Pose> T_map_imu_at_stamp = trajectory.at(sweep->stamp);
  if (!T_map_imu_at_stamp) return T_map_imu_at_stamp.reason();

  BatchedSweep result;
  result.stamp = sweep->stamp;
  result.frame = sweep->frame;
  result.sweep = sweep;
  result.T_map_lidar = *T_map_imu_at_stamp * T_imu_lidar;
  const auto count = static_cast<std::size_t>(batches);
  const std::vector<Group> groups = span.time_ordered
                                        ? groupsInOrder(sweep->points, count)
                                        : groupsByTime(sweep->points, count, result.batch_of_point);
  result.batches.reserve(groups.size());
  for (const Group& group : groups) {
    const Stamp stamp = sweep->stamp + fromSeconds(group.time_sum_s / group.count);
    const Outcome<Pose> T_map_imu = trajectory.at(std::clamp(stamp, span.first, span.last));  // rounding only
    if (!T_map_imu) return T_map_imu.reason();
    const bool range = span.time_ordered;
    result.batches.push_back(
        {range ? group.first : 0U, range ? group.count : 0U, stamp, *T_map_imu * T_imu_lidar});
  }
  return result;
}

}  // namespace atlas
