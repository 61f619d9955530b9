// SPDX-License-Identifier: MIT
#include "atlas/camera/depth_stage.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "atlas/camera/depth_buffer.hpp"

namespace atlas {
namespace {

std::vector<std::string> inputNames(const DepthParams& params) {
  validate(params);
  std::vector<std::string> names = {"tf_static", "odometry"};
  for (const std::string& lidar : params.lidars) names.push_back(lidar + "/batches");
  for (const std::string& camera : params.cameras) names.push_back(camera + "/camera_info");
  return names;
}

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("depth: " + field + " must be " + need + ", got " + std::to_string(value));
}

}  // namespace

void validate(const DepthParams& params) {
  if (params.cameras.empty())
    throw std::invalid_argument("depth: cameras must name at least one camera, got none");
  if (params.lidars.empty())
    throw std::invalid_argument("depth: lidars must name at least one lidar, got none");
  if (!(params.window_s > 0.0)) reject("window_s", "positive", params.window_s);
  if (!(params.min_depth_m > 0.0)) reject("min_depth_m", "positive", params.min_depth_m);
  if (!(params.max_depth_m > params.min_depth_m))
    reject("max_depth_m", "above min_depth_m", params.max_depth_m);
  if (params.splat_px < 0 || params.splat_px > 50) reject("splat_px", "in 0..50", params.splat_px);
  if (!(params.max_pose_gap_s > 0.0)) reject("max_pose_gap_s", "positive", params.max_pose_gap_s);
}

DepthStage::DepthStage(const DepthParams& params)
    : Stage("depth", inputNames(params)),
      params_(params),
      poses_(params.max_pose_gap_s),
      window_(fromSeconds(params.window_s)),
      intrinsics_(params.cameras.size(), IntrinsicsCache(params.min_depth_m, params.max_depth_m)),
      image_count_(params.cameras.size(), 0) {}

void DepthStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}

void DepthStage::push(const Odometry& odometry) {
  enqueue(kOdometry, odometry.stamp, [this, odometry] {
    poses_.push(odometry, counters_);
    answerReady();
    poses_.forgetBefore(waiting_.empty() ? odometry.stamp : waiting_.front().info.stamp);
  });
}

void DepthStage::push(std::size_t lidar, const BatchedSweepPtr& batches) {
  enqueue(lidarInput(lidar), batches->stamp, [this, batches] {
    if (batches->batches.empty()) counters_.skip("sweep", Reason::kNoPoseYet);
    window_.push(batches);
  });
}

void DepthStage::push(std::size_t camera, const CameraInfo& info) {
  const std::uint32_t index = image_count_.at(camera)++;  // counted on arrival: a late image keeps its number
  enqueue(cameraInfoInput(camera), info.stamp, [this, camera, info, index] { take(camera, info, index); });
}

void DepthStage::take(std::size_t camera, const CameraInfo& info, std::uint32_t image_index) {
  Waiting waiting{camera, image_index, info, rig_.T_imu(info.frame), window_.since(info.stamp)};
  waiting_.push_back(std::move(waiting));
  answerReady();
}

Stamp DepthStage::heldBackFrom() const { return waiting_.empty() ? kEndOfTime : waiting_.front().info.stamp; }

void DepthStage::onProgress() { answerReady(); }

void DepthStage::onEnd() { answerReady(); }  // all inputs have ended: every pose is known or unknown for good

void DepthStage::answerReady() {
  while (!waiting_.empty()) {
    const auto T_map_imu = poses_.at(waiting_.front().info.stamp, merge().watermark());
    if (!T_map_imu) return;
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    answer(waiting, *T_map_imu);
  }
}

void DepthStage::answer(const Waiting& waiting, const Outcome<Pose>& T_map_imu) {
  auto image = std::make_shared<DepthImage>();
  image->stamp = waiting.info.stamp;
  image->camera = params_.cameras[waiting.camera];
  image->image_index = waiting.image_index;
  image->camera_info = waiting.info;
  const Outcome<Intrinsics>& intrinsics = intrinsics_[waiting.camera].of(waiting.info);
  if (!intrinsics) {
    counters_.skip("depth image", intrinsics.reason());
  } else {
    const Outcome<cv::Mat> depth = render(waiting, *intrinsics, T_map_imu);
    if (depth) {
      image->depth = *depth;
    } else {
      counters_.skip("depth image", depth.reason());
      image->depth = DepthBuffer(intrinsics->model.width(), intrinsics->model.height()).image(0);
    }
  }
  counters_.add("depth images");
  if (on_depth) on_depth(waiting.camera, image);
}

Outcome<cv::Mat> DepthStage::render(const Waiting& waiting, const Intrinsics& intrinsics,
                                    const Outcome<Pose>& T_map_imu) {
  if (!T_map_imu) return T_map_imu.reason();
  if (!waiting.T_imu_camera) return waiting.T_imu_camera.reason();
  if (waiting.sweeps.empty()) return Reason::kNoPoints;
  const Pose T_camera_map = (*T_map_imu * *waiting.T_imu_camera).inverse();
  DepthBuffer buffer(intrinsics.model.width(), intrinsics.model.height());
  std::uint64_t seen = 0;
  for (const CompactSweepPtr& sweep : waiting.sweeps) {
    intrinsics.projector.projectSweep(*sweep, T_camera_map, [&](const ProjectedPoint& point) {
      buffer.add(point);
      ++seen;
    });
  }
  counters_.add("points in depth images", seen);
  return buffer.image(params_.splat_px);
}

}  // namespace atlas
