// SPDX-License-Identifier: MIT
#include "atlas/camera/depth_stage.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace atlas {
namespace {

constexpr double kSurfaceStep_m =
    0.15;  // beside surface_step: noise of ranges and poses, and the roughness of things
constexpr double kSurfaceSlope =
    0.12;  // share of the depth by which two ends of a gap on one surface may differ

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

std::vector<std::string> DepthParams::names() const {
  std::vector<std::string> result = cameras;
  if (!virtual_camera.name.empty()) result.push_back(virtual_camera.name);
  return result;
}

void validate(const DepthParams& params) {
  if (params.cameras.empty())
    throw std::invalid_argument("depth: cameras must name at least one camera, got none");
  if (params.lidars.empty())
    throw std::invalid_argument("depth: lidars must name at least one lidar, got none");
  if (!(params.window_s > 0.0)) reject("window_s", "positive", params.window_s);
  if (!(params.min_depth_m > 0.0)) reject("min_depth_m", "positive", params.min_depth_m);
  if (!(params.max_depth_m > params.min_depth_m))
    reject("max_depth_m", "above min_depth_m", params.max_depth_m);
  if (!(params.look_ahead_s >= 0.0)) reject("look_ahead_s", ">= 0", params.look_ahead_s);
  if (!(params.recent_s >= 0.0)) reject("recent_s", ">= 0", params.recent_s);
  if (!(params.line_gap_deg > 0.0 && params.line_gap_deg < 45.0))
    reject("line_gap_deg", "in 0..45, not 0", params.line_gap_deg);
  if (!(params.surface_step > 0.0 && params.surface_step < 1.0))
    reject("surface_step", "in 0..1, not 0 or 1", params.surface_step);
  if (!(params.fill_gap_m >= 0.0)) reject("fill_gap_m", ">= 0", params.fill_gap_m);
  if (!(params.max_pose_gap_s > 0.0)) reject("max_pose_gap_s", "positive", params.max_pose_gap_s);
  validate(params.virtual_camera);
  if (std::count(params.cameras.begin(), params.cameras.end(), params.virtual_camera.name) > 0)
    throw std::invalid_argument("depth: the virtual camera must not be one of cameras, got '" +
                                params.virtual_camera.name + "'");
}

DepthStage::DepthStage(const DepthParams& params)
    : Stage("depth", inputNames(params)),
      params_(params),
      names_(params.names()),
      look_ahead_(fromSeconds(params.look_ahead_s)),
      poses_(params.max_pose_gap_s),
      window_(fromSeconds(params.window_s)),
      sweep_origins_(params.lidars),
      intrinsics_(names_.size(), IntrinsicsCache(params.min_depth_m, params.max_depth_m)),
      image_count_(params.cameras.size(), 0),
      buffers_(names_.size()) {}

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
  const Origin origin = sweep_origins_.next(lidar, batches->stamp);
  enqueue(lidarInput(lidar), batches->stamp, [this, batches, origin] {
    if (batches->batches.empty()) counters_.skip("sweep", Reason::kNoPoseYet);
    const CompactSweepPtr sweep = window_.push(batches, origin);
    if (!sweep) return;
    for (Waiting& waiting : waiting_) {
      if (sweep->stamp <= waiting.info.stamp + look_ahead_) waiting.sweeps.push_back(sweep);
    }
  });
}

void DepthStage::push(std::size_t camera, const CameraInfo& info) {
  const std::uint32_t index = image_count_.at(camera)++;  // counted on arrival: a late image keeps its number
  enqueue(cameraInfoInput(camera), info.stamp, [this, camera, info, index] {
    take(camera, info, index, rig_.T_imu(info.frame));
    const VirtualCameraParams& from = params_.virtual_camera;
    if (camera == 0 && !from.name.empty())
      take(params_.cameras.size(), virtualInfo(from, info.stamp), index, T_imu_virtual(from));
  });
}

void DepthStage::take(std::size_t camera, const CameraInfo& info, std::uint32_t image_index,
                      const Outcome<Pose>& T_imu_camera) {
  waiting_.push_back({camera, image_index, info, T_imu_camera, window_.since(info.stamp)});
  answerReady();
}

Stamp DepthStage::heldBackFrom() const { return waiting_.empty() ? kEndOfTime : waiting_.front().info.stamp; }

void DepthStage::onProgress() { answerReady(); }

void DepthStage::onEnd() { answerReady(); }  // all inputs have ended: every pose is known or unknown for good

void DepthStage::answerReady() {
  while (!waiting_.empty()) {
    const Stamp stamp = waiting_.front().info.stamp;
    if (merge().watermark() < stamp + look_ahead_) return;
    const auto T_map_imu = poses_.at(stamp, merge().watermark());
    if (!T_map_imu) return;
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    answer(waiting, *T_map_imu);
  }
}

void DepthStage::answer(const Waiting& waiting, const Outcome<Pose>& T_map_imu) {
  auto image = std::make_shared<DepthImage>();
  image->stamp = waiting.info.stamp;
  image->camera = names_[waiting.camera];
  image->image_index = waiting.image_index;
  image->camera_info = waiting.info;
  auto confidence = std::make_shared<DepthImage>(*image);
  const Outcome<Intrinsics>& intrinsics = intrinsics_[waiting.camera].of(waiting.info);
  if (!intrinsics) {
    counters_.skip("depth image", intrinsics.reason());
  } else {
    const Outcome<DepthBuffer::Images> rendered = render(waiting, *intrinsics, T_map_imu);
    if (rendered) {
      image->depth = rendered->depth;
      confidence->depth = rendered->confidence;
    } else {
      counters_.skip("depth image", rendered.reason());
      image->depth = cv::Mat(intrinsics->model.height(), intrinsics->model.width(), CV_32FC1,
                             cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
    }
  }
  counters_.add("depth images");
  if (on_origins) {
    ProductOrigins origins{image->camera + "/depth/image", image->image_index, image->stamp, {}};
    const std::size_t trigger = waiting.camera < params_.cameras.size() ? waiting.camera : 0;
    origins.origins.push_back(
        {params_.cameras[trigger] + "/camera_info", image->stamp, image->image_index, {}});
    addOrigins(origins, waiting.sweeps);
    on_origins(origins);
  }
  if (on_confidence) on_confidence(waiting.camera, confidence);
  if (on_depth) on_depth(waiting.camera, image);
}

Outcome<DepthBuffer::Images> DepthStage::render(const Waiting& waiting, const Intrinsics& intrinsics,
                                                const Outcome<Pose>& T_map_imu) {
  if (!T_map_imu) return T_map_imu.reason();
  if (!waiting.T_imu_camera) return waiting.T_imu_camera.reason();
  if (waiting.sweeps.empty()) return Reason::kNoPoints;
  const Pose T_camera_map = (*T_map_imu * *waiting.T_imu_camera).inverse();
  const cv::Size size(intrinsics.model.width(), intrinsics.model.height());
  std::unique_ptr<DepthBuffer>& kept = buffers_[waiting.camera];
  if (!kept || kept->size() != size) kept = std::make_unique<DepthBuffer>(size.width, size.height);
  DepthBuffer& buffer = *kept;
  const Duration near_in_time = fromSeconds(params_.recent_s);
  std::uint64_t seen = 0;
  for (const CompactSweepPtr& sweep : waiting.sweeps) {
    intrinsics.projector.projectBatches(
        *sweep, T_camera_map, [&](const ProjectedPoint& point, const CompactSweep::Batch& batch) {
          buffer.add(point, std::abs(batch.stamp - waiting.info.stamp) <= near_in_time);
          ++seen;
        });
  }
  counters_.add("points in depth images", seen);
  const double line_gap_px = intrinsics.model.fx() * params_.line_gap_deg * M_PI / 180.0;
  if (params_.hide_occluded) buffer.removeInvisible({line_gap_px, params_.surface_step, kSurfaceStep_m});
  return buffer.takeFilled({intrinsics.model.fx(), params_.fill_gap_m, line_gap_px, kSurfaceSlope});
}

}  // namespace atlas
