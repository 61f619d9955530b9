// SPDX-License-Identifier: MIT
#include "track_kitti.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "atlas/fusion/box_measurement.hpp"
#include "atlas/fusion/object_tracker.hpp"
#include "atlas/output/objects_text.hpp"
#include "record/kitti_tracking.hpp"

namespace atlas_loader {
namespace {

namespace fs = std::filesystem;
using atlas::record::KittiClass;
using atlas::record::KittiDetection;

constexpr atlas::Duration kPeriod = 100 * atlas::kMillisecond;  ///< the benchmark's 10 Hz
constexpr double kScoreMiddle = 2.5, kScoreSlope = 0.5;  ///< PointRCNN: as many right as wrong ones, log odds
constexpr double kLeastRatio = 1.5, kMostRatio = 20.0;   ///< what is wrong does not repeat itself
constexpr double kDetected = 0.7;  ///< share of the objects in the image that have a detection
constexpr double kSameBox = 0.5;   ///< overlap of a 2D detection with that of a box
constexpr double kSeenTwice = 3.0,
                 kSeenOnce = 0.7;  ///< factor of the likelihood with and without a 2D detection

std::int32_t cocoClass(KittiClass kitti_class) {
  return kitti_class == KittiClass::kCar ? 2 : kitti_class == KittiClass::kCyclist ? 1 : 0;
}

double overlap2d(const KittiDetection& a, const KittiDetection& b) {
  const double w = std::min(a.x2, b.x2) - std::max(a.x1, b.x1),
               h = std::min(a.y2, b.y2) - std::max(a.y1, b.y1);
  if (w <= 0.0 || h <= 0.0) return 0.0;
  return w * h / ((a.x2 - a.x1) * (a.y2 - a.y1) + (b.x2 - b.x1) * (b.y2 - b.y1) - w * h);
}

atlas::Obstacle boxInMap(const KittiDetection& d, const atlas::Pose& T_map_camera) {
  atlas::Obstacle box;
  box.center = T_map_camera * (d.bottom_camera - Eigen::Vector3d(0.0, 0.5 * d.size.z(), 0.0));
  const Eigen::Vector3d forward =
      T_map_camera.rotation * Eigen::Vector3d(std::cos(d.rotation_y_rad), 0.0, -std::sin(d.rotation_y_rad));
  box.yaw_rad = std::atan2(forward.y(), forward.x());
  box.size = d.size;
  return box;
}

/// Detections of one frame as a scan; 2D detections, where there are any, vouch for those with a box.
atlas::Scan scanOf(const std::vector<KittiDetection>& detections, const atlas::Pose& T_map_camera,
                   bool has_2d) {
  atlas::Scan scan;
  scan.input = "detections";
  for (const KittiDetection& d : detections) {
    if (!d.has_box) continue;
    atlas::WholeBox::Noise noise;
    noise.position_m = 0.15 + 0.006 * d.bottom_camera.norm();  // of range, at most 0.5 m at 60 m
    auto box = std::make_unique<atlas::WholeBox>(boxInMap(d, T_map_camera), noise);
    box->index = d.index;
    box->coco_class = cocoClass(d.kitti_class);
    box->score = d.score;
    const bool seen_twice =
        std::any_of(detections.begin(), detections.end(), [&](const KittiDetection& other) {
          return !other.has_box && other.kitti_class == d.kitti_class && overlap2d(d, other) > kSameBox;
        });
    const double factor = !has_2d ? 1.0 : seen_twice ? kSeenTwice : kSeenOnce;
    box->existence_ratio =
        std::clamp(std::exp(kScoreSlope * (d.score - kScoreMiddle)) * factor, kLeastRatio, kMostRatio);
    box->confidence = 1.0 / (1.0 + std::exp(-d.score));
    scan.measurements.push_back(std::move(box));
  }
  return scan;
}

class Sequence {
 public:
  Sequence(const TrackKittiOptions& options, const std::string& name, const std::vector<fs::path>& files,
           atlas::record::RecordLog& log)
      : calibration_(
            atlas::record::readKittiTrackingCalibration(fs::path(options.calibration) / (name + ".txt"))),
        poses_(atlas::record::readKittiTrackingPoses(fs::path(options.oxts) / (name + ".txt"))),
        detections_(atlas::record::readKittiDetections(files, log)) {
    if (!detections_.empty() && detections_.rbegin()->first >= poses_.size())
      throw std::runtime_error(options.oxts + "/" + name + ".txt: " + std::to_string(poses_.size()) +
                               " poses, but there are detections in frame " +
                               std::to_string(detections_.rbegin()->first));
    for (const auto& [frame, list] : detections_) {
      for (const KittiDetection& d : list) has_2d_ = has_2d_ || !d.has_box;
    }
  }
  [[nodiscard]] std::size_t frames() const { return poses_.size(); }

  std::string track() const {
    atlas::TrackerParams params;
    params.classes.classes = {"Pedestrian=0", "Cyclist=1", "Car=2"};
    params.classes.none_prior = 0.02;  // the detector knows no others
    params.history = 0;
    atlas::ObjectTracker tracker(params);
    atlas::Counters counters;
    std::string text;
    for (std::uint32_t frame = 0; frame < poses_.size(); ++frame) {
      const atlas::Pose T_map_camera = poses_[frame] * calibration_.T_imu_camera;
      const atlas::KittiCamera camera{T_map_camera.inverse(), calibration_.P2};
      const auto found = detections_.find(frame);
      atlas::Scan scan = scanOf(found == detections_.end() ? std::vector<KittiDetection>{} : found->second,
                                T_map_camera, has_2d_);
      scan.stamp = static_cast<atlas::Stamp>(frame) * kPeriod + kPeriod;
      scan.detectability = [&camera](const atlas::TrackShape& shape) {
        const Eigen::Vector3d p =
            camera.T_camera_map *
            Eigen::Vector3d(shape.position().x(), shape.position().y(), shape.middle_z_m.value);
        const Eigen::Vector3d pixel = *camera.projection * p.homogeneous();
        const double u = pixel.x() / pixel.z();
        const bool inside = p.z() > 1.0 && u > 0.0 && u < 2.0 * (*camera.projection)(0, 2);
        return inside ? kDetected : 0.95;  // what has left the image does not come back
      };
      tracker.update(scan, counters);
      for (const atlas::Object& object : tracker.reportAll(scan.stamp).objects) {
        const bool seen = object.unseen_s <= 0.0;
        if (!seen && (object.existence < params.tell_existence || object.age_s < 0.15)) continue;
        if (const auto row = kittiTrackingRow(frame, object, camera)) text += *row;
      }
    }
    return text;
  }

 private:
  atlas::record::KittiTrackingCalibration calibration_;
  std::vector<atlas::Pose> poses_;
  atlas::record::KittiDetections detections_;
  bool has_2d_ = false;
};

}  // namespace

TrackKittiReport trackKitti(const TrackKittiOptions& options) {
  TrackKittiReport report;
  const auto sequences = atlas::record::findKittiDetections(options.detections);
  if (sequences.empty())
    throw std::invalid_argument(options.detections + ": no detections (files named 0000.txt, ...)");
  fs::create_directories(options.out);
  for (const auto& [name, files] : sequences) {
    const Sequence sequence(options, name, files, report.log);
    const auto begin = std::chrono::steady_clock::now();
    const std::string text = sequence.track();
    report.tracking_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    report.frames[name] = sequence.frames();
    const fs::path path = fs::path(options.out) / (name + ".txt"), temporary = path.string() + ".part";
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw std::runtime_error("cannot write " + temporary.string());
    fs::rename(temporary, path);
  }
  return report;
}

}  // namespace atlas_loader
