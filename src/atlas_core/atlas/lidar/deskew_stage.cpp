// SPDX-License-Identifier: MIT
#include "atlas/lidar/deskew_stage.hpp"

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
      trajectory_(max_pose_gap_) {}

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
  if (!T_map_imu.translation.allFinite() || !T_map_imu.rotation.coeffs().allFinite()) {
    counters_.skip("odometry", Reason::kNotFinite);
    return;
  }
  if (!trajectory_.empty() && odometry.stamp <= trajectory_.poses().back().stamp) {
    counters_.skip("odometry", Reason::kOutOfOrder);
    return;
  }
  // Sweeps whose time has run out get their answer before this pose, whether or not a watermark came in
  // between.
  answerReady(odometry.stamp - 1);
  trajectory_.push({odometry.stamp, T_map_imu});
  trajectory_.forgetBefore(odometry.stamp - kPoseHistory);
  answerReady(odometry.stamp - 1);
}

bool DeskewStage::isReady(const Waiting& waiting, Stamp odometry_known) const {
  if (!waiting.span || !waiting.T_imu_lidar) return true;  // no pose can help
  const Stamp last = waiting.span->last;
  const bool reached = !trajectory_.empty() && trajectory_.poses().back().stamp >= last;
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

void DeskewStage::answer(const Waiting& waiting) {
  const SweepPtr points = filtered(waiting);
  Outcome<BatchedSweep> batched = Reason::kEmpty;
  if (!waiting.span) {
    batched = waiting.span.reason();
  } else if (!waiting.T_imu_lidar) {
    batched = waiting.T_imu_lidar.reason();
  } else if (params_.batches_per_sweep == 0) {
    batched = deskewPerPoint(points, *waiting.span, trajectory_, *waiting.T_imu_lidar);
  } else {
    batched =
        cutIntoBatches(points, *waiting.span, params_.batches_per_sweep, trajectory_, *waiting.T_imu_lidar);
  }
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
