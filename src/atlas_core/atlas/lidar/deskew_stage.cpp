// SPDX-License-Identifier: MIT
#include "atlas/lidar/deskew_stage.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "atlas/lidar/per_point.hpp"
#include "atlas/lidar/range_gate.hpp"

namespace atlas {
namespace {

/// A sweep that still waits began at most this long before the newest pose: its first point is at most
/// kMaxPointTime_s before its stamp, and its stamp is not older than that of the sweep it waits behind, whose
/// last point is yet to come.
constexpr Duration kPoseHistory = 2 * static_cast<Duration>(kMaxPointTime_s) * kSecond;
constexpr double kLargeCorrection_m = 0.5;  // within a sweep: more than any fix that is believed makes

std::vector<std::string> inputNames(const DeskewParams& params) {
  validate(params);
  std::vector<std::string> names = {"tf_static", "odometry"};
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/points");
  return names;
}

[[noreturn]] void refuse(const std::string& what, double value) {
  throw std::invalid_argument("deskew: " + what + ", got " + std::to_string(value));
}

}  // namespace

void validate(const DeskewParams& params) {
  if (params.lidars.empty()) throw std::invalid_argument("deskew: lidars must name at least one lidar");
  if (params.batches_per_sweep < 0 || params.batches_per_sweep > std::numeric_limits<std::uint16_t>::max()) {
    refuse("batches_per_sweep must lie in 0..65535", params.batches_per_sweep);
  }
  if (!(params.min_range_m >= 0.0)) refuse("min_range_m must not be negative", params.min_range_m);
  if (!(params.max_range_m > params.min_range_m))
    refuse("max_range_m must exceed min_range_m", params.max_range_m);
  if (!(params.max_pose_gap_s > 0.0 && params.max_pose_gap_s <= 10.0)) {
    refuse("max_pose_gap_s must lie in (0, 10]", params.max_pose_gap_s);
  }
  for (const int ring : params.dead_rings) {
    if (ring < 0 || ring > std::numeric_limits<std::uint16_t>::max())
      refuse("dead_rings must lie in 0..65535", ring);
  }
  if (params.motion != "velocities" && params.motion != "poses")
    throw std::invalid_argument("deskew: motion must be velocities or poses, got '" + params.motion + "'");
  try {
    (void)scanStampNamed(params.scan_stamp);
    (void)vehicleBoxFrom(params.vehicle_box_m);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("deskew: ") + error.what());
  }
}

DeskewStage::DeskewStage(const DeskewParams& params)
    : Stage("deskew", inputNames(params)),
      params_(params),
      scan_stamp_(scanStampNamed(params.scan_stamp)),
      filter_{vehicleBoxFrom(params.vehicle_box_m), params.dead_rings, params.drop_duplicates},
      max_pose_gap_(fromSeconds(params.max_pose_gap_s)),
      motion_(max_pose_gap_) {}

void DeskewStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}

void DeskewStage::push(const Odometry& odometry) {
  enqueue(kOdometry, odometry.stamp, [this, odometry] { take(odometry); });
}

void DeskewStage::push(std::size_t lidar, const SweepPtr& sweep) {
  enqueue(kFirstLidar + lidar, sweep->stamp, [this, lidar, sweep] {
    counters_.add("sweeps");
    const SweepPtr timed = withStampAt(sweep, scan_stamp_);
    waiting_.push_back({lidar, timed, spanOf(*timed), rig_.T_imu(timed->frame)});
    answerReady(sweep->stamp - 1);
  });
}

void DeskewStage::take(const Odometry& odometry) {
  const Pose& T_map_imu = odometry.T_map_imu;
  if (!T_map_imu.translation.allFinite() || !T_map_imu.rotation.coeffs().allFinite() ||
      !odometry.velocity_imu_mps.allFinite() || !odometry.angular_velocity_imu_radps.allFinite()) {
    counters_.skip("odometry", Reason::kNotFinite);
    return;
  }
  const Trajectory& known = motion_.inMap();
  if (!known.empty() && odometry.stamp <= known.poses().back().stamp) {
    counters_.skip("odometry", Reason::kOutOfOrder);
    return;
  }
  // Sweeps whose time has run out get their answer before this pose, whether or not a watermark came in
  // between.
  answerReady(odometry.stamp - 1);
  if (params_.motion == "poses") {
    motion_.push(StampedPose{odometry.stamp, T_map_imu});
  } else {
    motion_.push(odometry);
  }
  motion_.forgetBefore(odometry.stamp - kPoseHistory);
  answerReady(odometry.stamp - 1);
}

bool DeskewStage::isReady(const Waiting& waiting, Stamp odometry_known) const {
  if (!waiting.span || !waiting.T_imu_lidar) return true;  // no pose can help
  const Stamp last = waiting.span->last;
  const Trajectory& known = motion_.inMap();
  const bool reached = !known.empty() && known.poses().back().stamp >= last;
  // A later pose would be too far from the last one before `last` to interpolate.
  return reached || odometry_known >= last + max_pose_gap_;
}

void DeskewStage::answerReady(Stamp odometry_known) {
  while (!waiting_.empty() && isReady(waiting_.front(), odometry_known)) {
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    answer(waiting);
  }
}

SweepPtr DeskewStage::filtered(const Waiting& waiting) {
  const GatedSweep gated = gateByRange(waiting.sweep, params_.min_range_m, params_.max_range_m);
  counters_.add("points outside the range gate", gated.gated);
  if (filter_.doesNothing() || !waiting.T_imu_lidar) return gated.sweep;
  const FilteredSweep result = filterPoints(gated.sweep, filter_, *waiting.T_imu_lidar);
  counters_.add("points on the vehicle", result.on_vehicle);
  counters_.add("points of dead rings", result.of_dead_rings);
  counters_.add("duplicate points", result.duplicates);
  return result.sweep;
}

void DeskewStage::countCorrection(const Trajectory& poses, const SweepSpan& span) {
  const auto correction_m = [&](Stamp stamp) {
    const Outcome<Pose> moved = poses.at(stamp), in_map = motion_.inMap().at(stamp);
    return moved && in_map ? (moved->translation - in_map->translation).norm() : 0.0;
  };
  if (std::max(correction_m(span.first), correction_m(span.last)) > kLargeCorrection_m)
    counters_.add("sweeps with a jump of the position, or whose odometry has no velocities");
}

Outcome<BatchedSweep> DeskewStage::batched(const Waiting& waiting, const SweepPtr& points) {
  if (!waiting.span) return waiting.span.reason();
  if (!waiting.T_imu_lidar) return waiting.T_imu_lidar.reason();
  const SweepSpan& span = *waiting.span;
  const Outcome<Trajectory> poses = motion_.around(points->stamp, span.first, span.last);
  if (!poses) return poses.reason();
  countCorrection(*poses, span);
  if (params_.batches_per_sweep == 0) return deskewPerPoint(points, span, *poses, *waiting.T_imu_lidar);
  return cutIntoBatches(points, span, params_.batches_per_sweep, *poses, *waiting.T_imu_lidar);
}

void DeskewStage::answer(const Waiting& waiting) {
  const SweepPtr points = filtered(waiting);
  const Outcome<BatchedSweep> batched = this->batched(waiting, points);
  auto result = std::make_shared<BatchedSweep>();
  if (batched) {
    *result = *batched;
  } else {
    counters_.skip("sweep of " + params_.lidars[waiting.lidar], batched.reason());
    result->stamp = waiting.sweep->stamp;
    result->frame = waiting.sweep->frame;
    result->sweep = points;
  }
  if (on_batches) on_batches(waiting.lidar, result);
}

Stamp DeskewStage::heldBackFrom() const {
  return waiting_.empty() ? kEndOfTime : waiting_.front().sweep->stamp;
}

void DeskewStage::onProgress() { answerReady(merge().watermark()); }

void DeskewStage::onEnd() { answerReady(kEndOfTime); }

}  // namespace atlas
