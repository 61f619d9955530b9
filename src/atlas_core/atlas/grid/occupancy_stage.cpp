// SPDX-License-Identifier: MIT
#include "atlas/grid/occupancy_stage.hpp"

#include <algorithm>
#include <utility>

namespace atlas {
namespace {

constexpr Duration kMaxPoseGap = kSecond / 2;

std::vector<std::string> inputNames(const OccupancyParams& params) {
  validate(params);
  std::vector<std::string> names = {"tf_static", "odometry"};
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  for (const std::string& stereo : params.stereo) names.push_back(stereo + "/ground");
  return names;
}

}  // namespace

OccupancyStage::OccupancyStage(const OccupancyParams& params)
    : Stage("occupancy", inputNames(params)), params_(params), trajectory_(kMaxPoseGap), chain_(params) {}

void OccupancyStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}

void OccupancyStage::push(const Odometry& odometry) {
  enqueue(kOdometry, odometry.stamp, [this, odometry] {
    const Pose& T_map_imu = odometry.T_map_imu;
    const bool again = !motions_.empty() && odometry.stamp <= motions_.back().stamp;
    if (again || !T_map_imu.translation.allFinite() || !T_map_imu.rotation.coeffs().allFinite()) {
      counters_.skip("odometry", again ? Reason::kOutOfOrder : Reason::kNotFinite);
      return;
    }
    closeBefore(odometry.stamp);
    trajectory_.push({odometry.stamp, T_map_imu});
    motions_.push_back(odometry);
    answerReady(odometry.stamp - 1);
    const Stamp asked = std::min(heldBackFrom(), odometry.stamp);
    trajectory_.forgetBefore(asked);
    while (motions_.size() > 1 && motions_[1].stamp <= asked) motions_.pop_front();
  });
}

void OccupancyStage::push(std::size_t lidar, const BatchedSweepPtr& batches) {
  enqueue(kFirstLidar + lidar, batches->stamp, [this, lidar, batches] {
    closeBefore(batches->stamp);
    if (open_ && open_->sweeps[lidar]) close();
    groupFor(batches->stamp).sweeps[lidar] = batches;
    counters_.add("sweeps");
  });
}

void OccupancyStage::push(std::size_t stereo, const SensorGridPtr& grid) {
  enqueue(stereoInput(stereo), grid->stamp, [this, stereo, grid] {
    closeBefore(grid->stamp);
    if (open_ && open_->grids[stereo]) close();
    groupFor(grid->stamp).grids[stereo] = grid;
    counters_.add("stereo grids");
  });
}

OccupancyStage::Group& OccupancyStage::groupFor(Stamp stamp) {
  if (!open_) {
    open_ = Group{stamp, stamp, {}, {}};
    open_->sweeps.resize(params_.lidars.size());
    open_->grids.resize(params_.stereo.size());
  }
  open_->last = stamp;
  return *open_;
}

/// The open group is complete once something later than its span is known.
void OccupancyStage::closeBefore(Stamp stamp) {
  if (open_ && stamp - open_->first > fromSeconds(params_.group_s)) close();
}

void OccupancyStage::close() {
  waiting_.push_back(std::move(*open_));
  open_.reset();
}

void OccupancyStage::answerReady(Stamp odometry_known) {
  while (!waiting_.empty()) {
    const Stamp asked = waiting_.front().last;
    const bool reached = !trajectory_.empty() && trajectory_.poses().back().stamp >= asked;
    if (!reached && odometry_known < asked + kMaxPoseGap) return;
    const Group group = std::move(waiting_.front());
    waiting_.pop_front();
    answer(group);
  }
}

void OccupancyStage::answer(const Group& group) {
  const Outcome<Pose> T_map_imu = trajectory_.at(group.last);
  if (!T_map_imu) {
    counters_.skip("grid update", T_map_imu.reason());
    auto nothing = std::make_shared<OccupancyFrame>();
    nothing->stamp = nothing->objects.stamp = group.last;
    if (on_frame) on_frame(nothing);
    return;
  }
  OccupancyInput input;
  input.stamp = group.last;
  input.T_map_imu = *T_map_imu;
  for (const Odometry& motion : motions_) {
    if (motion.stamp <= group.last && toSeconds(group.last - motion.stamp) <= params_.max_odometry_age_s)
      input.motion = motion;
  }
  for (const BatchedSweepPtr& sweep : group.sweeps) {
    if (sweep) input.lidars.push_back(pickLayers(*sweep, params_.layers));
  }
  for (const SensorGridPtr& grid : group.grids) {
    if (!grid) continue;
    const Outcome<Pose> T_imu_sensor = rig_.T_imu(grid->frame), T_map_then = trajectory_.at(grid->stamp);
    if (T_imu_sensor && T_map_then) {
      input.grids.push_back({grid, *T_map_then * *T_imu_sensor * grid->T_sensor_grid});
    } else {
      counters_.skip("grid of stereo", T_imu_sensor ? T_map_then.reason() : T_imu_sensor.reason());
    }
  }
  const OccupancyFramePtr frame = chain_.update(input, counters_);
  if (on_frame) on_frame(frame);
}

Stamp OccupancyStage::heldBackFrom() const {
  if (!waiting_.empty()) return waiting_.front().first;
  return open_ ? open_->first : kEndOfTime;
}

void OccupancyStage::onProgress() {
  const Stamp known = merge().watermark();
  if (known != kBeginOfTime) closeBefore(known);
  answerReady(known);
}

void OccupancyStage::onEnd() {
  if (open_) close();
  answerReady(kEndOfTime);
}

}  // namespace atlas
