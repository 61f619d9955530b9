// SPDX-License-Identifier: MIT
#include "atlas/camera/thermal_stage.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "atlas/camera/box_occlusion.hpp"
#include "atlas/camera/thermal_projection.hpp"

namespace atlas {
namespace {

constexpr double kMinDepth_m = 0.1, kMaxDepth_m = 200.0;  // of the points that may hide an object

std::vector<std::string> inputNames(const ThermalParams& params) {
  validate(params);
  std::vector<std::string> names = {"tf_static", "odometry", params.thermal_camera + "/camera_info"};
  for (const std::string& camera : params.cameras) names.push_back(camera + "/frustums");
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
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
  if (!(params.neighbour_s >= 0.0)) reject("neighbour_s", ">= 0", params.neighbour_s);
  if (!(params.bridged_confidence >= 0.0 && params.bridged_confidence <= 1.0))
    reject("bridged_confidence", "in 0..1", params.bridged_confidence);
  if (!(params.max_hidden_fraction >= 0.0 && params.max_hidden_fraction <= 1.0))
    reject("max_hidden_fraction", "in 0..1", params.max_hidden_fraction);
  if (!(params.look_ahead_s >= 0.0)) reject("look_ahead_s", ">= 0", params.look_ahead_s);
  if (!(params.recent_s >= 0.0)) reject("recent_s", ">= 0", params.recent_s);
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
      neighbour_(fromSeconds(params.neighbour_s)),
      look_ahead_(fromSeconds(params.look_ahead_s)),
      poses_(params.max_pose_gap_s),
      window_(fromSeconds(params.look_ahead_s + params.recent_s)),
      sweep_origins_(params.lidars),
      intrinsics_(kMinDepth_m, kMaxDepth_m),
      before_(params.cameras.size()) {}

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
    frames_.push_back({info, index, rig_.T_imu(info.frame), window_.since(info.stamp), {}});
  });
}

void ThermalStage::push(std::size_t camera, const Frustums& frustums) {
  enqueue(kFirstCamera + camera, frustums.stamp, [this, camera, frustums] {
    pending_.push_back({camera, frustums});
  });
}

void ThermalStage::push(std::size_t lidar, const BatchedSweepPtr& batches) {
  const Origin origin = sweep_origins_.next(lidar, batches->stamp);
  enqueue(lidarInput(lidar), batches->stamp, [this, batches, origin] {
    const CompactSweepPtr sweep = window_.push(batches, origin);
    if (!sweep) return;
    for (ThermalFrame& frame : frames_) {
      if (sweep->stamp <= frame.info.stamp + look_ahead_) frame.sweeps.push_back(sweep);
    }
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
    const std::optional<const Frustums*> after = imageAfterOldest();
    if (!after) return;
    Source source = takeOldest(*after);
    const auto nearest = nearestFrame(stamp);
    if (nearest) {
      choose(frames_[*nearest], std::move(source));
    } else {
      counters_.add("skipped frustums: no thermal frame near in time");
    }
  }
}

std::optional<const Frustums*> ThermalStage::imageAfterOldest() const {
  const Pending& oldest = pending_.front();
  const Stamp latest = oldest.frustums.stamp + neighbour_;
  const auto next = std::find_if(pending_.begin() + 1, pending_.end(),
                                 [&](const Pending& other) { return other.camera == oldest.camera; });
  if (next == pending_.end())
    return merge().watermark() >= latest ? std::optional<const Frustums*>(nullptr) : std::nullopt;
  return next->frustums.stamp <= latest ? &next->frustums : nullptr;
}

ThermalStage::Source ThermalStage::takeOldest(const Frustums* after) {
  Pending image = std::move(pending_.front());
  std::optional<Frustums>& last = before_[image.camera];
  const bool is_near = last && image.frustums.stamp - last->stamp <= neighbour_;
  FrustumMotionParams motion;
  motion.bridged_confidence = params_.bridged_confidence;
  const std::array<const Frustums*, 3> seen = {is_near ? &*last : nullptr, &image.frustums, after};
  Source source{
      image.camera, image.frustums.stamp, followObjects(seen[0], image.frustums, after, motion), {}};
  for (const Frustums* used : seen) {
    if (used == nullptr) continue;
    source.origins.push_back(
        {params_.cameras[image.camera] + "/frustums", used->stamp, used->image_index, {}});
  }
  last = std::move(image.frustums);
  pending_.pop_front();
  return source;
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
    const Duration theirs = std::abs(other.stamp - frame.info.stamp);
    const Duration ours = std::abs(source.stamp - frame.info.stamp);
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
  if (!frames_.front().chosen_by.empty() && !params_.lidars.empty())
    reach = std::max(reach, stamp + look_ahead_);
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
    result.source_stamps.push_back(source.stamp);
    if (!intrinsics) {
      counters_.skip("thermal box", intrinsics.reason(), source.objects.size());
    } else if (!frame.T_imu_thermal) {
      counters_.skip("thermal box", frame.T_imu_thermal.reason(), source.objects.size());
    } else if (!T_map_imu) {
      counters_.skip("thermal box", T_map_imu.reason(), source.objects.size());
    } else {
      const Pose T_thermal_map = (*T_map_imu * *frame.T_imu_thermal).inverse();
      std::vector<Label> labels = project(frame, source, intrinsics->model, T_thermal_map);
      dropHidden(labels, frame, intrinsics->projector, T_thermal_map);
      for (const Label& label : labels) {
        result.detections.boxes.push_back(label.box);
        result.source_index.push_back(label.source_index);
        counters_.add(label.source_index == kBridged ? "thermal boxes bridged" : "thermal boxes");
      }
    }
  }
  tellOrigins(frame);
  if (on_projected) on_projected(result);
}

void ThermalStage::tellOrigins(const ThermalFrame& frame) const {
  if (!on_origins) return;
  const std::string& camera = params_.thermal_camera;
  ProductOrigins product{camera + "/projected_detections", frame.index, frame.info.stamp, {}};
  product.origins.push_back({camera + "/camera_info", frame.info.stamp, frame.index, {}});
  for (const Source& source : frame.chosen_by)
    product.origins.insert(product.origins.end(), source.origins.begin(), source.origins.end());
  if (!frame.chosen_by.empty()) addOrigins(product, frame.sweeps);
  on_origins(product);
}

std::vector<ThermalStage::Label> ThermalStage::project(const ThermalFrame& frame, const Source& source,
                                                       const CameraModel& model, const Pose& T_thermal_map) {
  const ThermalBoxLimits limits{params_.min_box_px, params_.min_visible_fraction};
  std::vector<Label> labels;
  for (const MovingFrustum& object : source.objects) {
    const Frustum now = moved(object, toSeconds(frame.info.stamp - source.stamp));
    const BoxInImage seen = projectFront(now, model, T_thermal_map, limits);
    if (seen.loss != BoxLoss::kNone) {
      counters_.add(std::string("skipped thermal box: ") + toString(seen.loss));
      continue;
    }
    labels.push_back({seen.box, object.index, (T_thermal_map * now.position).z()});
  }
  return labels;
}

void ThermalStage::dropHidden(std::vector<Label>& labels, const ThermalFrame& frame,
                              const Projector& projector, const Pose& T_thermal_map) {
  std::vector<BoxOcclusion> views;
  for (const Label& label : labels) views.emplace_back(label.box, label.front_m, OcclusionParams{});
  const Duration recent = fromSeconds(params_.recent_s);
  for (const CompactSweepPtr& sweep : frame.sweeps) {
    projector.projectBatches(*sweep, T_thermal_map,
                             [&](const ProjectedPoint& point, const CompactSweep::Batch& batch) {
                               if (std::abs(batch.stamp - frame.info.stamp) > recent) return;
                               for (BoxOcclusion& view : views) view.add(point);
                             });
  }
  std::vector<Label> seen;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::optional<double> hidden = views[i].hiddenShare();
    if (hidden && *hidden > params_.max_hidden_fraction) {
      counters_.add("skipped thermal box: hidden by something nearer");
    } else {
      seen.push_back(labels[i]);
    }
  }
  labels = std::move(seen);
}

}  // namespace atlas
