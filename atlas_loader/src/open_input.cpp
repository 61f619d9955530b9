// SPDX-License-Identifier: MIT
#include "open_input.hpp"

#include <ros/package.h>

#include <algorithm>
#include <stdexcept>

#include "atlas_ros/bag_reader.hpp"
#include "record/open_record.hpp"

namespace atlas_loader {
namespace {

atlas::RecordOptions::Images imagesFrom(const std::string& text) {
  if (text == "h265") return atlas::RecordOptions::Images::kPackets;
  if (text == "jpeg") return atlas::RecordOptions::Images::kEncoded;
  if (text == "raw") return atlas::RecordOptions::Images::kPixels;
  throw std::invalid_argument("images must be h265, jpeg or raw, got '" + text + "'");
}

atlas::RecordOptions::ScanStamp scanStampFrom(const std::string& text) {
  if (text == "end") return atlas::RecordOptions::ScanStamp::kEnd;
  if (text == "start") return atlas::RecordOptions::ScanStamp::kStart;
  throw std::invalid_argument("scan_stamp must be end or start, got '" + text + "'");
}

/// A bag has its stamps already.
void rejectLatencies(const InputOptions& options) {
  const std::pair<const char*, double> latencies[] = {{"imu_latency_s", options.imu_latency_s},
                                                      {"gnss_latency_s", options.gnss_latency_s},
                                                      {"lidar_latency_s", options.lidar_latency_s}};
  for (const auto& [name, value] : latencies) {
    if (value == 0.0) continue;
    throw std::invalid_argument(std::string(name) + " is for records, a bag has its stamps already; got " +
                                std::to_string(value));
  }
}

}  // namespace

std::unique_ptr<atlas::RecordReader> openInput(const InputOptions& options) {
  if (options.bag.empty() == options.record.empty()) {
    throw std::invalid_argument("name one input: a bag or a record, got bag '" + options.bag +
                                "' and record '" + options.record + "'");
  }
  if (!options.bag.empty()) {
    rejectLatencies(options);
    atlas_ros::BagOptions bag;
    bag.start_s = options.start_s;
    bag.duration_s = options.duration_s;
    bag.topics = options.topics;
    return atlas_ros::openBag(options.bag, bag);
  }
  atlas::RecordOptions record;
  record.calibration_dir = options.calibration;
  record.packaged_rig_dir = packageFile("atlas_bringup", "config/rigs/bud");
  record.start_s = options.start_s;
  record.duration_s = options.duration_s;
  record.topics = options.topics;
  record.images = imagesFrom(options.images);
  record.imu_latency_s = options.imu_latency_s;
  record.gnss_latency_s = options.gnss_latency_s;
  record.lidar_latency_s = options.lidar_latency_s;
  record.scan_stamp = scanStampFrom(options.scan_stamp);
  return atlas::openRecord(options.record, record);
}

std::string configurationFor(const std::vector<atlas::StreamInfo>& streams) {
  const auto is_of_kitti = [](const atlas::StreamInfo& stream) {
    return stream.topic.rfind("velodyne/", 0) == 0 || stream.topic.rfind("image_0", 0) == 0;
  };
  return std::any_of(streams.begin(), streams.end(), is_of_kitti) ? "kitti" : "bud";
}

std::string packageFile(const std::string& package, const std::string& relative) {
  const std::string folder = ros::package::getPath(package);
  if (folder.empty()) throw std::runtime_error("package " + package + " is not in ROS_PACKAGE_PATH");
  return folder + "/" + relative;
}

}  // namespace atlas_loader
