// SPDX-License-Identifier: MIT
#include "atlas/camera/camera_lidar_stage.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "atlas/camera/foreground.hpp"
#include "atlas/camera/frustum.hpp"
#include "atlas/camera/frustum_merge.hpp"
#include "atlas/camera/pixel_box.hpp"

namespace atlas {
namespace {

constexpr double kMinDepth_m = 0.1;  // nearer points would be inside the lens
constexpr double kThinnest_m = 0.1;

std::vector<std::string> inputNames(const CameraLidarParams& params) {
  validate(params);
  std::vector<std::string> names = {"tf_static", "odometry"};
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  for (const std::string& camera : params.cameras) names.push_back(camera + "/camera_info");
  if (!params.gate_on_sensors.empty()) names.emplace_back("sensor_status");
  for (const std::string& camera : params.cameras) names.push_back(camera + "/detections");
  return names;
}

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("camera_lidar: " + field + " must be " + need + ", got " +
                              std::to_string(value));
}

/// A detection that lies in the image, and the depths of the points seen through it.
struct Candidate {
  std::uint32_t index;
  Detection2d box;  ///< part in the image
  PixelBox pixels;  ///< the same
  std::vector<BoxPoint> points;
};

/// The smallest box around all boxes: most points of the road and of the sky lie outside.
Detection2d around(const std::vector<Candidate>& candidates) {
  Detection2d all = candidates.front().box;
  for (const Candidate& c : candidates) {
    all.x_min = std::min(all.x_min, c.box.x_min);
    all.y_min = std::min(all.y_min, c.box.y_min);
    all.x_max = std::max(all.x_max, c.box.x_max);
    all.y_max = std::max(all.y_max, c.box.y_max);
  }
  return all;
}

/// The paper's distance: the median of all that is inside the box.
Outcome<Foreground> medianOf(const std::vector<BoxPoint>& points, const CameraLidarParams& params) {
  std::vector<float> depths_m;
  depths_m.reserve(points.size());
  for (const BoxPoint& point : points) depths_m.push_back(point.depth_m);
  const Outcome<RobustDepth> depth = robustDepth(depths_m);
  if (!depth) return depth.reason();
  if (points.size() < static_cast<std::size_t>(params.min_points)) return Reason::kLowQuality;
  return Foreground{depth->median_m, depth->median_m + params.object_depth_m, depth->sigma_m, points.size()};
}

Outcome<Foreground> measure(const Detection2d& box, std::vector<BoxPoint>& points,
                            const CameraLidarParams& params) {
  if (params.method == "median") return medianOf(points, params);
  ForegroundParams foreground;
  foreground.recent_s = params.recent_s;
  foreground.min_points = params.min_points;
  const Outcome<Foreground> found = findForeground(box, points, foreground);
  if (!found) return found.reason();
  Foreground object = *found;
  object.back_m = std::max(object.back_m, object.front_m + kThinnest_m);
  return object;
}

}  // namespace

void validate(const CameraLidarParams& params) {
  if (params.cameras.empty())
    throw std::invalid_argument("camera_lidar: cameras must name at least one camera, got none");
  if (params.lidars.empty())
    throw std::invalid_argument("camera_lidar: lidars must name at least one lidar, got none");
  if (params.method != "foreground" && params.method != "median")
    throw std::invalid_argument("camera_lidar: method must be foreground or median, got '" + params.method +
                                "'");
  validate(params.gate_on_sensors, "camera_lidar");
  if (!(params.look_ahead_s >= 0.0)) reject("look_ahead_s", ">= 0", params.look_ahead_s);
  if (!(params.recent_s >= 0.0)) reject("recent_s", ">= 0", params.recent_s);
  if (!(params.window_s > 0.0)) reject("window_s", "positive", params.window_s);
  if (!(params.max_depth_m > kMinDepth_m)) reject("max_depth_m", "above 0.1", params.max_depth_m);
  if (params.min_points < 1) reject("min_points", "at least 1", params.min_points);
  if (!(params.object_depth_m > 0.0)) reject("object_depth_m", "positive", params.object_depth_m);
  if (!(params.merge_within_s >= 0.0)) reject("merge_within_s", ">= 0", params.merge_within_s);
  if (!(params.max_pose_gap_s > 0.0)) reject("max_pose_gap_s", "positive", params.max_pose_gap_s);
}

CameraLidarStage::CameraLidarStage(const CameraLidarParams& params)
    : Stage("camera_lidar", inputNames(params)),
      params_(params),
      gate_(params.gate_on_sensors),
      look_ahead_(fromSeconds(params.look_ahead_s)),
      poses_(params.max_pose_gap_s),
      window_(fromSeconds(params.window_s)),
      sweep_origins_(params.lidars),
      camera_info_(params.cameras.size()),
      intrinsics_(params.cameras.size(), IntrinsicsCache(kMinDepth_m, params.max_depth_m)) {}

void CameraLidarStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}

void CameraLidarStage::push(const Odometry& odometry) {
  enqueue(kOdometry, odometry.stamp, [this, odometry] {
    poses_.push(odometry, counters_);
    answerReady();
    poses_.forgetBefore(waiting_.empty() ? odometry.stamp : waiting_.front().detections.stamp);
  });
}

void CameraLidarStage::push(std::size_t lidar, const BatchedSweepPtr& batches) {
  const Origin origin = sweep_origins_.next(lidar, batches->stamp);
  enqueue(lidarInput(lidar), batches->stamp, [this, batches, origin] {
    if (batches->batches.empty()) counters_.skip("sweep", Reason::kNoPoseYet);
    const CompactSweepPtr sweep = window_.push(batches, origin);
    if (!sweep) return;
    for (Waiting& waiting : waiting_) {
      if (sweep->stamp <= waiting.detections.stamp + look_ahead_) waiting.sweeps.push_back(sweep);
    }
  });
}

void CameraLidarStage::push(std::size_t camera, const CameraInfo& info) {
  enqueue(cameraInfoInput(camera), info.stamp, [this, camera, info] { camera_info_[camera] = info; });
}

void CameraLidarStage::push(std::size_t camera, const Detections& detections) {
  enqueue(detectionsInput(camera), detections.stamp,
          [this, camera, detections] { take(camera, detections); });
}

void CameraLidarStage::push(const SensorStatus& status) {
  enqueue(gateInput(), status.stamp, [this, status] { gate_.add(status); });
}

void CameraLidarStage::take(std::size_t camera, const Detections& detections) {
  const std::optional<CameraInfo>& info = camera_info_[camera];
  const Outcome<Pose> T_imu_camera =
      info ? rig_.T_imu(info->frame) : Outcome<Pose>(Reason::kMissingIntrinsics);
  const bool trusted = gate_.open(params_.cameras[camera]);
  Waiting waiting{camera, detections, info, trusted, T_imu_camera, window_.since(detections.stamp)};
  waiting_.push_back(std::move(waiting));
  answerReady();
}

Stamp CameraLidarStage::heldBackFrom() const {
  if (!group_.empty()) return group_.front().stamp;
  return waiting_.empty() ? kEndOfTime : waiting_.front().detections.stamp;
}

void CameraLidarStage::onProgress() { answerReady(); }

// All inputs have ended: every pose is known or unknown for good.
void CameraLidarStage::onEnd() {
  answerReady();
  mergeGroup();
}

void CameraLidarStage::answerReady() {
  while (answerOldest()) {
  }
  if (group_.empty()) return;
  const Stamp last = group_.front().stamp + fromSeconds(params_.merge_within_s);
  const bool one_waits = !waiting_.empty() && waiting_.front().detections.stamp <= last;
  if (!one_waits && merge().watermark() >= last) mergeGroup();
}

bool CameraLidarStage::answerOldest() {
  if (waiting_.empty()) return false;
  const Stamp stamp = waiting_.front().detections.stamp;
  if (merge().watermark() < stamp + look_ahead_) return false;
  const auto T_map_imu = poses_.at(stamp, merge().watermark());
  if (!T_map_imu) return false;
  const Waiting waiting = std::move(waiting_.front());
  waiting_.pop_front();
  answer(waiting, *T_map_imu);
  return true;
}

void CameraLidarStage::mergeGroup() {
  if (group_.empty()) return;
  const Frustums merged = mergeDuplicates(group_, {});
  std::size_t seen = 0;
  for (const Frustums& image : group_) seen += image.frustums.size();
  counters_.add("frustums of the same object by another camera", seen - merged.frustums.size());
  if (on_origins) {
    ProductOrigins origins{"frustums", merged_count_++, merged.stamp, {}};
    for (const Frustums& image : group_)
      origins.origins.push_back({image.camera + "/frustums", image.stamp, image.image_index, {}});
    on_origins(origins);
  }
  group_.clear();
  if (on_merged) on_merged(merged);
}

void CameraLidarStage::answer(const Waiting& waiting, const Outcome<Pose>& T_map_imu) {
  Frustums result;
  result.stamp = waiting.detections.stamp;
  result.camera = params_.cameras[waiting.camera];
  result.image_index = waiting.detections.image_index;
  const std::size_t boxes = waiting.detections.boxes.size();
  const Outcome<Intrinsics> none = Reason::kMissingIntrinsics;
  const Outcome<Intrinsics>& intrinsics = waiting.info ? intrinsics_[waiting.camera].of(*waiting.info) : none;
  if (!waiting.trusted) {
    counters_.add("skipped detection: score of its camera below its limit", boxes);
  } else if (!intrinsics) {
    counters_.skip("detection", intrinsics.reason(), boxes);
  } else if (!waiting.T_imu_camera) {
    counters_.skip("detection", waiting.T_imu_camera.reason(), boxes);
  } else if (!T_map_imu) {
    counters_.skip("detection", T_map_imu.reason(), boxes);
  } else {
    result.frustums = frustumsOf(waiting, *intrinsics, *T_map_imu * *waiting.T_imu_camera);
  }
  counters_.add("images with detections");
  counters_.add("detections", boxes);
  counters_.add("frustums", result.frustums.size());
  if (!group_.empty() && result.stamp > group_.front().stamp + fromSeconds(params_.merge_within_s))
    mergeGroup();
  group_.push_back(result);
  if (on_origins) {
    ProductOrigins origins{result.camera + "/frustums", result.image_index, result.stamp, {}};
    origins.origins.push_back({result.camera + "/detections", result.stamp, result.image_index, {}});
    addOrigins(origins, waiting.sweeps);
    on_origins(origins);
  }
  if (on_frustums) on_frustums(waiting.camera, result);
}

std::vector<Frustum> CameraLidarStage::frustumsOf(const Waiting& waiting, const Intrinsics& intrinsics,
                                                  const Pose& T_map_camera) {
  std::vector<Candidate> candidates;
  for (std::uint32_t i = 0; i < waiting.detections.boxes.size(); ++i) {
    const Outcome<Detection2d> box = clipToImage(waiting.detections.boxes[i], intrinsics.model);
    if (box) {
      candidates.push_back({i, *box, PixelBox(*box), {}});
    } else {
      counters_.skip("detection", box.reason());
    }
  }
  if (candidates.empty()) return {};
  const Pose T_camera_map = T_map_camera.inverse();
  const PixelBox all(around(candidates));
  for (const CompactSweepPtr& sweep : waiting.sweeps) {
    intrinsics.projector.projectBatches(
        *sweep, T_camera_map, [&](const ProjectedPoint& point, const CompactSweep::Batch& batch) {
          if (!all.holds(point)) return;
          const auto time_s = static_cast<float>(toSeconds(batch.stamp - waiting.detections.stamp));
          for (Candidate& c : candidates) {
            if (c.pixels.holds(point)) c.points.push_back({point.u, point.v, point.depth_m, time_s});
          }
        });
  }
  std::vector<Frustum> frustums;
  for (Candidate& c : candidates) {
    const Outcome<Foreground> object = measure(c.box, c.points, params_);
    if (!object) {
      counters_.skip("detection", object.reason());
      continue;
    }
    Outcome<Frustum> made = makeFrustum(c.box, {object->front_m, object->sigma_m},
                                        object->back_m - object->front_m, intrinsics.model, T_map_camera);
    if (!made) {
      counters_.skip("detection", made.reason());
      continue;
    }
    Frustum frustum = *made;
    frustum.detection_index = c.index;
    frustum.detection = waiting.detections.boxes[c.index];
    frustum.points = static_cast<std::uint32_t>(object->points);
    frustums.push_back(frustum);
  }
  return frustums;
}

}  // namespace atlas
