// SPDX-License-Identifier: MIT
// A KITTI raw drive (Geiger et al. 2013): oxts, velodyne_points, image_02, image_03 and calib_*.txt, in the
// record folder, deeper inside it, or (calibration) above it. base_link is the OXTS unit. Streams, in this
// order: tf_static; imu/data, gnss/fix, gnss/heading; velodyne/points; for image_02 and image_03:
// camera_info, pictures as stored or pixels. Without velodyne or image timestamps the frame time is that of
// the OXTS row of the same index minus 17 ms.
#pragma once

#include <filesystem>
#include <memory>

#include "record/open_record.hpp"

namespace atlas::record {

bool isKittiDrive(const std::filesystem::path& folder);
std::unique_ptr<RecordReader> openKittiDrive(const std::filesystem::path& folder,
                                             const RecordOptions& options);

}  // namespace atlas::record
