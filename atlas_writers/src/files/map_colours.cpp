// SPDX-License-Identifier: MIT
#include "files/map_colours.hpp"

#include "atlas/sensor/same_calibration.hpp"

namespace atlas {

MapColours::MapColours(std::size_t cameras, Counters& counters)
    : counters_(counters), poses_(kMaxPoseGap_s), cameras_(cameras) {}

void MapColours::add(std::size_t camera, const CameraInfo& info) {
  waiting_[{info.stamp, camera}].info = info;
}
void MapColours::add(std::size_t camera, const ImagePtr& picture) {
  waiting_[{picture->stamp, camera}].picture = picture;
}
void MapColours::addDepth(std::size_t camera, const DepthImagePtr& depth) {
  waiting_[{depth->stamp, camera}].depth = depth;
}
void MapColours::addConfidence(std::size_t camera, const DepthImagePtr& confidence) {
  waiting_[{confidence->stamp, camera}].confidence = confidence;
}

void MapColours::answer(Stamp merged, const std::function<void(const std::vector<ColouredPoint>&)>& visit) {
  while (!waiting_.empty()) {
    const auto& [stamp, camera] = waiting_.begin()->first;
    if (stamp > merged) return;
    const auto T_map_imu = poses_.at(stamp, merged);
    if (!T_map_imu) return;
    const auto seen = coloured(camera, waiting_.begin()->second, *T_map_imu);
    if (seen) {
      counters_.add("pictures");
      counters_.add("coloured points", seen->size());
      visit(*seen);
    } else {
      counters_.skip("picture", seen.reason());
    }
    poses_.forgetBefore(stamp);
    waiting_.erase(waiting_.begin());
  }
}

Outcome<std::vector<ColouredPoint>> MapColours::coloured(std::size_t camera, const Parts& parts,
                                                         const Outcome<Pose>& T_map_imu) {
  if (!parts.picture || parts.picture->pixels.empty()) return Reason::kEmpty;
  if (!parts.depth || !parts.confidence || parts.confidence->depth.empty()) return Reason::kNoPoints;
  if (parts.picture->pixels.type() != CV_8UC3) return Reason::kBadLayout;
  if (!T_map_imu) return T_map_imu.reason();
  const Outcome<Pose> T_imu_camera = rig_.T_imu(parts.info.frame);
  if (!T_imu_camera) return T_imu_camera.reason();
  PixelBearings* const bearings = bearingsOf(camera, parts.info);
  if (bearings == nullptr) return Reason::kMissingIntrinsics;
  const cv::Size size = bearings->size();
  if (parts.picture->pixels.size() != size || parts.depth->depth.size() != size) return Reason::kBadLayout;
  return pointColours(parts.picture->pixels, parts.depth->depth, parts.confidence->depth,
                      *T_map_imu * *T_imu_camera, *bearings);
}

PixelBearings* MapColours::bearingsOf(std::size_t camera, const CameraInfo& info) {
  Camera& known = cameras_.at(camera);
  if (known.bearings && sameCalibration(known.info, info)) return known.bearings.get();
  const Outcome<CameraModel> model = CameraModel::fromInfo(info);
  known.info = info;
  known.bearings = model ? std::make_unique<PixelBearings>(*model) : nullptr;
  return known.bearings.get();
}

}  // namespace atlas
