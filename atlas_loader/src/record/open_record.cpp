// SPDX-License-Identifier: MIT
#include "record/open_record.hpp"

#include <cmath>
#include <stdexcept>

#include "record/bud_reader.hpp"
#include "record/kitti_reader.hpp"

namespace atlas {

void validate(const RecordOptions& options) {
  const auto require = [](bool good, const char* field, double value, const char* need) {
    if (good) return;
    throw std::invalid_argument(std::string("record: ") + field + " must be " + need + ", got " +
                                std::to_string(value));
  };
  constexpr double kLongest = 1e9;  // s; 31 years
  const auto finite = [](double v) { return std::isfinite(v) && std::abs(v) < kLongest; };
  require(finite(options.start_s) && options.start_s >= 0, "start_s", options.start_s, ">= 0");
  require(finite(options.duration_s), "duration_s", options.duration_s, "finite");
  require(finite(options.imu_latency_s), "imu_latency_s", options.imu_latency_s, "finite");
  require(finite(options.gnss_latency_s), "gnss_latency_s", options.gnss_latency_s, "finite");
  require(finite(options.lidar_latency_s), "lidar_latency_s", options.lidar_latency_s, "finite");
}

std::unique_ptr<RecordReader> openRecord(const std::filesystem::path& folder, const RecordOptions& options) {
  validate(options);
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw std::invalid_argument("record: no such folder: '" + folder.string() + "'");
  }
  if (record::isBudRecord(folder)) return record::openBudRecord(folder, options);
  if (record::isKittiDrive(folder)) return record::openKittiDrive(folder, options);
  throw std::invalid_argument(
      "record: '" + folder.string() +
      "' is neither a Brno Urban Dataset record (imu/imu.txt, gnss/pose.txt, "
      "<sensor>/timestamps.txt) nor a KITTI raw drive (oxts/data, velodyne_points/data, "
      "image_02/data)");
}

}  // namespace atlas
