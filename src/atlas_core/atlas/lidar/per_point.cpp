// SPDX-License-Identifier: MIT
// One matrix per knot of time and its change to the next knot: p' = (M + a D) p. Everything is relative to
// the pose at the stamp, so coordinates are as small as the sensor's range and float is enough (8 um at 120
// m).
#include "atlas/lidar/per_point.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {
namespace {

constexpr Duration kKnot = kMillisecond / 2;
constexpr std::size_t kBlock = 512;  // points of 24 bytes: copied and moved while in the first cache

struct alignas(16) Knot {
  Eigen::Matrix4f at = Eigen::Matrix4f::Identity();  ///< T_stamp_knot
  Eigen::Matrix4f change = Eigen::Matrix4f::Zero();  ///< to the next knot
};

Eigen::Matrix4f matrixOf(const Pose& T) {
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.topRows<3>() = T.matrix34f();
  return m;
}

/// Knots every kKnot from span.first on; the last one lies at or after span.last and has the pose there.
Outcome<std::vector<Knot>> knotsOver(const SweepSpan& span, const Trajectory& trajectory,
                                     const Pose& T_imu_lidar, const Pose& T_lidar_map) {
  const auto count = static_cast<std::size_t>((span.last - span.first + kKnot - 1) / kKnot) + 1;
  std::vector<Knot> knots(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Stamp stamp = span.first + static_cast<Duration>(i) * kKnot;
    const Stamp within = std::min(stamp, span.last);
    const Outcome<Pose> T_map_imu = trajectory.at(within);
    if (!T_map_imu) return T_map_imu.reason();
    knots[i].at = matrixOf(T_lidar_map * (*T_map_imu * T_imu_lidar));
    if (i == 0) continue;
    // the last step may be a part of kKnot: the change is stretched to the whole of it
    const auto part = static_cast<float>(within - (stamp - kKnot)) / static_cast<float>(kKnot);
    knots[i - 1].change = (knots[i].at - knots[i - 1].at) / part;
  }
  return knots;
}

void movePoint(LidarPoint& p, const Knot& knot, float part) {
  const Eigen::Vector4f base =
      knot.at.col(0) * p.x + knot.at.col(1) * p.y + (knot.at.col(2) * p.z + knot.at.col(3));
  const Eigen::Vector4f change =
      knot.change.col(0) * p.x + knot.change.col(1) * p.y + (knot.change.col(2) * p.z + knot.change.col(3));
  const Eigen::Vector4f moved = base + part * change;
  const float intensity = p.intensity;
  Eigen::Map<Eigen::Vector4f> place(&p.x);  // one store; the fourth is the intensity, put back after
  place = moved;
  p.intensity = intensity;
}

}  // namespace

Outcome<BatchedSweep> deskewPerPoint(const SweepPtr& sweep, const SweepSpan& span,
                                     const Trajectory& trajectory, const Pose& T_imu_lidar) {
  const Outcome<Pose> T_map_imu = trajectory.at(sweep->stamp);
  if (!T_map_imu) return T_map_imu.reason();
  BatchedSweep result;
  result.stamp = sweep->stamp;
  result.frame = sweep->frame;
  result.T_map_lidar = *T_map_imu * T_imu_lidar;
  const Outcome<std::vector<Knot>> knots =
      knotsOver(span, trajectory, T_imu_lidar, result.T_map_lidar.inverse());
  if (!knots) return knots.reason();
  const Knot* const first = knots->data();
  const auto last = static_cast<int>(knots->size()) - 1;

  const auto begin_s = static_cast<float>(toSeconds(span.first - sweep->stamp));
  const auto per_s = static_cast<float>(1.0 / toSeconds(kKnot));
  auto moved = std::make_shared<Sweep>();
  moved->stamp = sweep->stamp;
  moved->frame = sweep->frame;
  std::vector<LidarPoint>& points = moved->points;
  points.reserve(sweep->points.size());
  for (std::size_t begin = 0; begin < sweep->points.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, sweep->points.size());
    points.insert(points.end(), sweep->points.begin() + static_cast<std::ptrdiff_t>(begin),
                  sweep->points.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t i = begin; i < end; ++i) {
      const float place = std::max(0.0F, (points[i].time - begin_s) * per_s);
      const int knot = std::min(static_cast<int>(place), last);
      movePoint(points[i], first[knot], place - static_cast<float>(knot));
    }
  }
  result.sweep = moved;
  result.batches.push_back({0, static_cast<std::uint32_t>(points.size()), sweep->stamp, result.T_map_lidar});
  return result;
}

}  // namespace atlas
