// SPDX-License-Identifier: MIT
#include "bag_check.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "atlas_ros/event_messages.hpp"

namespace atlas_loader {
namespace {

constexpr std::size_t kMostSamples = 1 << 16;  // per topic and statistic

double medianSeconds(std::vector<atlas::Duration> values) {
  if (values.empty()) return 0.0;
  auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return atlas::toSeconds(*middle);
}

std::string text(const char* format, const std::string& topic, double a, double b = 0) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, topic.c_str(), a, b);
  return buffer;
}

struct Acceleration {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double norm_sum = 0;
  std::uint64_t count = 0;
};

void addMissing(const std::map<std::string, atlas::StreamKind>& kinds, BagCheck& result) {
  const auto has = [&](atlas::StreamKind kind) {
    return std::any_of(kinds.begin(), kinds.end(), [&](const auto& entry) { return entry.second == kind; });
  };
  if (!has(atlas::StreamKind::kImu)) result.problems.emplace_back("no IMU (sensor_msgs/Imu): there will be no odometry");
  if (!has(atlas::StreamKind::kGnssFix)) result.problems.emplace_back("no GNSS fix (sensor_msgs/NavSatFix): there will be no odometry");
  if (!has(atlas::StreamKind::kPoints)) result.problems.emplace_back("no lidar (sensor_msgs/PointCloud2): there will be no map");
  if (!has(atlas::StreamKind::kStaticTransforms)) {
    result.problems.emplace_back("no /tf_static: the places of the sensors on the vehicle are unknown");
  }
  if (!has(atlas::StreamKind::kGnssHeading)) result.remarks.emplace_back("no GNSS heading: heading is known only after driving");
  if (!has(atlas::StreamKind::kCameraInfo)) result.remarks.emplace_back("no camera_info: no depth images, no frustums");
}

}  // namespace

void TopicStatistics::add(atlas::Stamp stamp, atlas::Stamp recorded) {
  if (messages_ > 0) {
    const atlas::Duration interval = stamp - last_;
    if (interval < 0) ++backwards_;
    if (interval == 0) ++duplicates_;
    largest_gap_ = std::max(largest_gap_, interval);
    if (messages_ % stride_ == 0) intervals_.push_back(interval);
  }
  if (messages_ % stride_ == 0) delays_.push_back(recorded - stamp);
  if (delays_.size() >= kMostSamples) {  // keep every second sample from now on
    for (auto* samples : {&intervals_, &delays_}) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < samples->size(); i += 2) (*samples)[kept++] = (*samples)[i];
      samples->resize(kept);
    }
    stride_ *= 2;
  }
  last_ = stamp;
  ++messages_;
}

TopicCheck TopicStatistics::result(const std::string& datatype) const {
  TopicCheck check;
  check.datatype = datatype;
  check.messages = messages_;
  const double interval = medianSeconds(intervals_);
  check.rate_hz = interval > 0 ? 1.0 / interval : 0.0;
  check.largest_gap_s = atlas::toSeconds(largest_gap_);
  check.backwards = backwards_;
  check.duplicates = duplicates_;
  check.median_delay_s = medianSeconds(delays_);
  return check;
}

std::string judgeGravity(const std::string& topic, const Eigen::Vector3d& mean_mps2, double mean_norm_mps2) {
  if (mean_norm_mps2 < 9.5 || mean_norm_mps2 > 10.5) {
    return text("%s: mean norm of the acceleration is %.2f m/s^2, not gravity (9.5 .. 10.5)", topic, mean_norm_mps2);
  }
  if (mean_mps2.z() < 0) {
    return text("%s: the acceleration at rest points down (mean z %.2f m/s^2): sign inverted against REP-145", topic, mean_mps2.z());
  }
  if (mean_mps2.z() < 0.8 * mean_norm_mps2) {
    return text("%s: gravity is not on the z axis (mean z %.2f of %.2f m/s^2): the IMU is mounted rotated", topic, mean_mps2.z(),
                mean_norm_mps2);
  }
  return "";
}

std::vector<std::string> judgeTopic(const std::string& topic, const TopicCheck& check) {
  std::vector<std::string> problems;
  if (check.backwards > 0) problems.push_back(text("%s: %.0f stamps go back", topic, static_cast<double>(check.backwards)));
  if (check.duplicates > 0) problems.push_back(text("%s: %.0f stamps occur twice", topic, static_cast<double>(check.duplicates)));
  constexpr double kSparse = 2.0;    // Hz; rarer messages may have gaps
  constexpr double kGapFactor = 5.0; // of the usual interval
  if (check.rate_hz > kSparse && check.largest_gap_s > std::max(0.2, kGapFactor / check.rate_hz)) {
    problems.push_back(text("%s: a gap of %.2f s at usually %.1f Hz", topic, check.largest_gap_s, check.rate_hz));
  }
  if (check.messages > 0 && std::abs(check.median_delay_s) > 1.0) {
    problems.push_back(text("%s: recorded %.2f s after its stamps (median)", topic, check.median_delay_s));
  }
  return problems;
}

BagCheck checkBag(const std::string& path) {
  rosbag::Bag bag;
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error("cannot open bag " + path + ": " + error.what());
  }
  std::map<std::string, TopicStatistics> statistics;
  std::map<std::string, std::string> types;
  std::map<std::string, atlas::StreamKind> kinds;
  std::map<std::string, Acceleration> accelerations;
  BagCheck result;
  rosbag::View view(bag);
  for (const rosbag::MessageInstance& m : view) {
    const std::string topic = m.getTopic();
    types[topic] = m.getDataType();
    const auto kind = atlas_ros::kindOf(topic, m.getDataType());
    if (!kind) continue;
    kinds[topic] = *kind;
    atlas_ros::withMessageType(*kind, [&](auto* type) {
      using Message = std::remove_pointer_t<decltype(type)>;
      const auto message = m.instantiate<Message>();
      statistics[topic].add(atlas_ros::stampOf(*message), atlas_ros::fromTime(m.getTime()));
      if constexpr (std::is_same_v<Message, sensor_msgs::Imu>) {
        if (*kind != atlas::StreamKind::kImu) return;
        const auto& a = message->linear_acceleration;
        Acceleration& sum = accelerations[topic];
        sum.sum += Eigen::Vector3d(a.x, a.y, a.z);
        sum.norm_sum += std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
        ++sum.count;
      }
    });
  }
  for (const auto& [topic, type] : types) {
    if (kinds.count(topic) == 0) {
      result.remarks.push_back(topic + " (" + type + ") is not used by the suite");
      continue;
    }
    const TopicCheck check = statistics[topic].result(type);
    result.topics[topic] = check;
    if (kinds[topic] == atlas::StreamKind::kStaticTransforms) continue;
    for (const std::string& problem : judgeTopic(topic, check)) result.problems.push_back(problem);
  }
  for (const auto& [topic, sum] : accelerations) {
    const double n = static_cast<double>(sum.count);
    const std::string problem = judgeGravity(topic, sum.sum / n, sum.norm_sum / n);
    if (!problem.empty()) result.problems.push_back(problem);
  }
  addMissing(kinds, result);
  return result;
}

}  // namespace atlas_loader
