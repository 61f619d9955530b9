// SPDX-License-Identifier: MIT
// Files of the KITTI tracking benchmark: calib/%04d.txt, oxts/%04d.txt and 3D or 2D detections as trackers
// are given them (AB3DMOT's layout): rows
//   frame,type,x1,y1,x2,y2,score,h,w,l,x,y,z,ry,alpha   (type 1 pedestrian, 2 car, 3 cyclist; h w l in m,
//   bottom centre and yaw in the rectified camera frame: x right, y down, z forward) frame,x1,y1,x2,y2,score
//   (2D, the class is the name of a folder above)
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "atlas/base/geometry.hpp"
#include "record/record_log.hpp"

namespace atlas::record {

enum class KittiClass : std::uint8_t { kPedestrian = 1, kCar = 2, kCyclist = 3 };
const char* toString(KittiClass kitti_class);

struct KittiDetection {
  KittiClass kitti_class = KittiClass::kCar;
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;  ///< px
  double score = 0;
  bool has_box = false;  ///< false: 2D only, what follows is unknown
  Eigen::Vector3d bottom_camera = Eigen::Vector3d::Zero(), size = Eigen::Vector3d::Zero();  ///< size: l, w, h
  double rotation_y_rad = 0;
  std::uint32_t index = 0;  ///< among the detections of the frame
};
/// By frame.
using KittiDetections = std::map<std::uint32_t, std::vector<KittiDetection>>;

/// Sequences ("0012") with the files that hold their detections, below `folder`.
std::map<std::string, std::vector<std::filesystem::path>> findKittiDetections(
    const std::filesystem::path& folder);
/// All detections of a sequence; rows that make no sense and repeated boxes are counted in the log.
KittiDetections readKittiDetections(const std::vector<std::filesystem::path>& files, RecordLog& log);

struct KittiTrackingCalibration {
  Pose T_imu_camera;  ///< of the rectified camera frame
  Eigen::Matrix<double, 3, 4> P2 = Eigen::Matrix<double, 3, 4>::Zero();
};
/// Throws std::runtime_error naming file and field.
KittiTrackingCalibration readKittiTrackingCalibration(const std::filesystem::path& file);
/// T_map_imu of each frame, map at the first. Throws std::runtime_error naming file, line, field and value.
std::vector<Pose> readKittiTrackingPoses(const std::filesystem::path& oxts_file);

}  // namespace atlas::record
