// SPDX-License-Identifier: MIT
#include "atlas/camera/thermal_stage.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "atlas/camera/thermal_projection.hpp"

namespace atlas {
namespace {

std::vector<std::string> inputNames(const ThermalParams& params) {
  validate(params);
  std::vector<std::string> names = {"tf_static", "odometry", params.thermal_camera + "/camera_info"};
  for (const std::string& camera : params.cameras) names.push_back(camera + "/frustums");
  return names;
}

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("thermal: " + field + " must be " + need + ", got " + std::to_string(value));
}

}  // namespace

void validate(const ThermalParams& params) {
  if (params.thermal_camera.empty())
    throw std::invalid_argument("thermal: thermal_camera must not be empty, got ''");
  if (params.cameras.empty())
    throw std::invalid_argument("thermal: cameras must name at least one camera, got none");
  if (!(params.max_time_difference_s >= 0.0))
    reject("max_time_difference_s", ">= 0", params.max_time_difference_s);
  if (!(params.min_box_px >= 0.0)) reject("min_box_px", ">= 0", params.min_box_px);
  if (!(params.min_visible_fraction >= 0.0 && params.min_visible_fraction <= 1.0)) {
    reject("min_visible_fraction", "in 0..1", params.min_visible_fraction);
  }
  if (!(params.max_pose_gap_s > 0.0)) reject("max_pose_gap_s", "positive", params.max_pose_gap_s);
}

ThermalStage::ThermalStage(const ThermalParams& params)
    : Stage("thermal", inputNames(params)),
      params_(params),
      max_difference_(fromSeconds(params.max_time_difference_s)),
      poses_(params.max_pose_gap_s),
      intrinsics_(0.1, 1000.0) {}  // depth limits of the projector, which this stage does not use

void ThermalStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}

void ThermalStage::push(const Odometry& odometry) {
  enqueue(kOdometry, odometry.stamp, [this, odometry] {
    poses_.push(odometry, counters_);
    poses_.forgetBefore(frames_.empty() ? odometry.stamp : frames_.front().info.stamp);
  });
}

void ThermalStage::pushThermal(const CameraInfo& info) {
  const std::uint32_t index = next_index_++;  // counted on arrival: a late frame keeps its number
  enqueue(kThermalInfo, info.stamp, [this, info, index] {
    frames_.push_back({info, index, rig_.T_imu(info.frame), {}});
  });
}

void ThermalStage::push(std::size_t camera, const Frustums& frustums) {
  enqueue(kFirstCamera + camera, frustums.stamp, [this, camera, frustums] {
    pending_.push_back({camera, frustums});
  });
}

Stamp ThermalStage::heldBackFrom() const { return frames_.empty() ? kEndOfTime : frames_.front().info.stamp; }

void ThermalStage::onProgress() {
  assign();
  answerReady();
}

void ThermalStage::onEnd() { onProgress(); }

void ThermalStage::assign() {
  while (!pending_.empty()) {
    const Stamp stamp = pending_.front().frustums.stamp;
    const bool frame_after = !frames_.empty() && frames_.back().info.stamp >= stamp;
    const bool none_can_come = merge().watermark() >= stamp + max_difference_;
    if (!frame_after && !none_can_come) return;
    Source source = std::move(pending_.front());
    pending_.pop_front();
    const auto nearest = nearestFrame(stamp);
    if (nearest) {
      choose(frames_[*nearest], std::move(source));
    } else {
      counters_.add("skipped frustums: no thermal frame near in time");
    }
  }
}

std::optional<std::size_t> ThermalStage::nearestFrame(Stamp stamp) const {
  std::optional<std::size_t> nearest;
  Duration smallest = max_difference_;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Duration difference = std::abs(frames_[i].info.stamp - stamp);
    if (difference > max_difference_ || (nearest && difference >= smallest)) continue;
    nearest = i;
    smallest = difference;
  }
  return nearest;
}

// Two images of one camera that chose the same frame would label every object twice: the nearer one counts,
// of two equally near ones the earlier.
void ThermalStage::choose(ThermalFrame& frame, Source source) {
  for (Source& other : frame.chosen_by) {
    if (other.camera != source.camera) continue;
    counters_.add("skipped frustums: another image of the camera is nearer to the thermal frame");
    const Duration theirs = std::abs(other.frustums.stamp - frame.info.stamp);
    const Duration ours = std::abs(source.frustums.stamp - frame.info.stamp);
    if (ours < theirs) other = std::move(source);
    return;
  }
  frame.chosen_by.push_back(std::move(source));
}

bool ThermalStage::oldestIsSettled() const {
  const Stamp stamp = frames_.front().info.stamp;
  Stamp reach = stamp + max_difference_;  // last stamp of an image that may choose it
  if (frames_.size() >= 2) {
    const Stamp next = frames_[1].info.stamp;
    reach = std::min(reach, stamp + (next - stamp) / 2);  // the middle goes to the earlier
  }
  const bool one_waits = !pending_.empty() && pending_.front().frustums.stamp <= reach;
  return !one_waits && merge().watermark() >= reach;
}

void ThermalStage::answerReady() {
  while (!frames_.empty() && oldestIsSettled()) {
    const auto T_map_imu = poses_.at(frames_.front().info.stamp, merge().watermark());
    if (!T_map_imu && !frames_.front().chosen_by.empty()) return;
    const ThermalFrame frame = std::move(frames_.front());
    frames_.pop_front();
    answer(frame, T_map_imu ? *T_map_imu : Outcome<Pose>(Reason::kPoseNotReached));
  }
}

void ThermalStage::answer(const ThermalFrame& frame, const Outcome<Pose>& T_map_imu) {
  ProjectedDetections result;
  result.detections.stamp = frame.info.stamp;
  result.detections.frame = frame.info.frame;
  result.detections.image_index = frame.index;
  result.selected = !frame.chosen_by.empty();
  counters_.add("thermal frames");
  if (result.selected) counters_.add("thermal frames selected");
  const Outcome<Intrinsics>& intrinsics = intrinsics_.of(frame.info);
  for (const Source& source : frame.chosen_by) {
    result.source_stamps.push_back(source.frustums.stamp);
    const std::size_t boxes = source.frustums.frustums.size();
    if (!intrinsics) {
      counters_.skip("thermal box", intrinsics.reason(), boxes);
    } else if (!frame.T_imu_thermal) {
      counters_.skip("thermal box", frame.T_imu_thermal.reason(), boxes);
    } else if (!T_map_imu) {
      counters_.skip("thermal box", T_map_imu.reason(), boxes);
    } else {
      projectInto(result, source, intrinsics->model, (*T_map_imu * *frame.T_imu_thermal).inverse());
    }
  }
  if (on_projected) on_projected(result);
}

void ThermalStage::projectInto(ProjectedDetections& result, const Source& source, const CameraModel& model,
                               const Pose& T_thermal_map) {
  const ThermalBoxLimits limits{params_.min_box_px, params_.min_visible_fraction};
  for (std::uint32_t i = 0; i < source.frustums.frustums.size(); ++i) {
    const BoxInImage seen = projectFront(source.frustums.frustums[i], model, T_thermal_map, limits);
    if (seen.loss != BoxLoss::kNone) {
      counters_.add(std::string("skipped thermal box: ") + toString(seen.loss));
      continue;
    }
    result.detections.boxes.push_back(seen.box);
    result.source_index.push_back(i);
    counters_.add("thermal boxes");
  }
}

}  // namespace atlas
