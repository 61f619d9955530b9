// SPDX-License-Identifier: MIT
#include "atlas/camera/camera_lidar_stage.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "atlas/camera/frustum.hpp"

namespace atlas {
namespace {

constexpr double kMinDepth_m = 0.1;  // nearer points would be inside the lens

std::vector<std::string> inputNames(const CameraLidarParams& params) {
  validate(params);
  std::vector<std::string> names = {"tf_static", "odometry"};
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  for (const std::string& camera : params.cameras) names.push_back(camera + "/camera_info");
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
  std::vector<float> depths_m;
};

bool holds(const Detection2d& box, const ProjectedPoint& point) {
  return point.u > box.x_min && point.u < box.x_max && point.v > box.y_min && point.v < box.y_max;
}

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

}  // namespace

void validate(const CameraLidarParams& params) {
  if (params.cameras.empty())
    throw std::invalid_argument("camera_lidar: cameras must name at least one camera, got none");
  if (params.lidars.empty())
    throw std::invalid_argument("camera_lidar: lidars must name at least one lidar, got none");
  if (!(params.window_s > 0.0)) reject("window_s", "positive", params.window_s);
  if (!(params.max_depth_m > kMinDepth_m)) reject("max_depth_m", "above 0.1", params.max_depth_m);
  if (params.min_points < 1) reject("min_points", "at least 1", params.min_points);
  if (!(params.object_depth_m > 0.0)) reject("object_depth_m", "positive", params.object_depth_m);
  if (!(params.max_pose_gap_s > 0.0)) reject("max_pose_gap_s", "positive", params.max_pose_gap_s);
}

CameraLidarStage::CameraLidarStage(const CameraLidarParams& params)
    : Stage("camera_lidar", inputNames(params)),
      params_(params),
      poses_(params.max_pose_gap_s),
      window_(fromSeconds(params.window_s)),
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
  enqueue(lidarInput(lidar), batches->stamp, [this, batches] {
    if (batches->batches.empty()) counters_.skip("sweep", Reason::kNoPoseYet);
    window_.push(batches);
  });
}

void CameraLidarStage::push(std::size_t camera, const CameraInfo& info) {
  enqueue(cameraInfoInput(camera), info.stamp, [this, camera, info] { camera_info_[camera] = info; });
}

void CameraLidarStage::push(std::size_t camera, const Detections& detections) {
  enqueue(detectionsInput(camera), detections.stamp,
          [this, camera, detections] { take(camera, detections); });
}

void CameraLidarStage::take(std::size_t camera, const Detections& detections) {
  const std::optional<CameraInfo>& info = camera_info_[camera];
  const Outcome<Pose> T_imu_camera =
      info ? rig_.T_imu(info->frame) : Outcome<Pose>(Reason::kMissingIntrinsics);
  Waiting waiting{camera, detections, info, T_imu_camera, window_.since(detections.stamp)};
  waiting_.push_back(std::move(waiting));
  answerReady();
}

Stamp CameraLidarStage::heldBackFrom() const {
  return waiting_.empty() ? kEndOfTime : waiting_.front().detections.stamp;
}

void CameraLidarStage::onProgress() { answerReady(); }

void CameraLidarStage::onEnd() {
  answerReady();
}  // all inputs have ended: every pose is known or unknown for good

void CameraLidarStage::answerReady() {
  while (!waiting_.empty()) {
    const auto T_map_imu = poses_.at(waiting_.front().detections.stamp, merge().watermark());
    if (!T_map_imu) return;
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    answer(waiting, *T_map_imu);
  }
}

void CameraLidarStage::answer(const Waiting& waiting, const Outcome<Pose>& T_map_imu) {
  Frustums result;
  result.stamp = waiting.detections.stamp;
  result.camera = params_.cameras[waiting.camera];
  result.image_index = waiting.detections.image_index;
  const std::size_t boxes = waiting.detections.boxes.size();
  const Outcome<Intrinsics> none = Reason::kMissingIntrinsics;
  const Outcome<Intrinsics>& intrinsics = waiting.info ? intrinsics_[waiting.camera].of(*waiting.info) : none;
  if (!intrinsics) {
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
  if (on_frustums) on_frustums(waiting.camera, result);
}

std::vector<Frustum> CameraLidarStage::frustumsOf(const Waiting& waiting, const Intrinsics& intrinsics,
                                                  const Pose& T_map_camera) {
  std::vector<Candidate> candidates;
  for (std::uint32_t i = 0; i < waiting.detections.boxes.size(); ++i) {
    const Outcome<Detection2d> box = clipToImage(waiting.detections.boxes[i], intrinsics.model);
    if (box) {
      candidates.push_back({i, *box, {}});
    } else {
      counters_.skip("detection", box.reason());
    }
  }
  if (candidates.empty()) return {};
  const Pose T_camera_map = T_map_camera.inverse();
  const Detection2d all = around(candidates);
  for (const CompactSweepPtr& sweep : waiting.sweeps) {
    intrinsics.projector.projectSweep(*sweep, T_camera_map, [&](const ProjectedPoint& point) {
      if (!holds(all, point)) return;
      for (Candidate& c : candidates) {
        if (holds(c.box, point)) c.depths_m.push_back(point.depth_m);
      }
    });
  }
  std::vector<Frustum> frustums;
  for (Candidate& c : candidates) {
    const std::size_t points = c.depths_m.size();
    const Outcome<RobustDepth> depth = robustDepth(c.depths_m);
    if (!depth || points < static_cast<std::size_t>(params_.min_points)) {
      counters_.skip("detection", depth ? Reason::kLowQuality : depth.reason());
      continue;
    }
    Outcome<Frustum> made =
        makeFrustum(c.box, *depth, params_.object_depth_m, intrinsics.model, T_map_camera);
    if (!made) {
      counters_.skip("detection", made.reason());
      continue;
    }
    Frustum frustum = *made;
    frustum.detection_index = c.index;
    frustum.detection = waiting.detections.boxes[c.index];
    frustum.points = static_cast<std::uint32_t>(points);
    frustums.push_back(frustum);
  }
  return frustums;
}

}  // namespace atlas
