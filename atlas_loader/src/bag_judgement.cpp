// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "atlas_ros/bag_reader.hpp"
#include "bag_check.hpp"

namespace atlas_loader {
namespace {

using atlas::StreamKind;

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

/// "+y" of (0.1, 9.8, 0.2); "" when no axis stands out.
std::string axisOf(const Eigen::Vector3d& v) {
  Eigen::Index axis = 0;
  if (v.cwiseAbs().maxCoeff(&axis) < 0.8 * v.norm()) return "";
  return std::string(v[axis] < 0 ? "-" : "+") + "xyz"[axis];
}

bool has(const std::map<std::string, TopicContent>& contents, StreamKind kind) {
  return std::any_of(contents.begin(), contents.end(),
                     [&](const auto& entry) { return entry.second.kind == kind; });
}

void addMissing(const std::map<std::string, TopicContent>& contents, BagCheck& result) {
  if (!has(contents, StreamKind::kImu))
    result.problems.emplace_back("no IMU (sensor_msgs/Imu): there will be no odometry");
  if (!has(contents, StreamKind::kGnssFix)) {
    result.problems.emplace_back("no GNSS fix (sensor_msgs/NavSatFix): there will be no odometry");
  }
  if (!has(contents, StreamKind::kPoints)) {
    result.problems.emplace_back("no lidar (sensor_msgs/PointCloud2): there will be no map");
  }
  if (!has(contents, StreamKind::kStaticTransforms)) {
    result.problems.emplace_back("no /tf_static: the places of the sensors on the vehicle are unknown");
  }
  if (!has(contents, StreamKind::kGnssHeading)) {
    result.remarks.emplace_back("no GNSS heading: heading is known only after driving");
  }
  if (!has(contents, StreamKind::kCameraInfo))
    result.remarks.emplace_back("no camera_info: no depth images, no frustums");
}

void judgeContent(const std::string& topic, const TopicContent& content, BagCheck& result) {
  for (const auto& [reason, messages] : content.unusable) {
    result.problems.push_back(text("%s: %.0f messages are unusable: ", topic, static_cast<double>(messages)) +
                              reason);
  }
  const auto n = static_cast<double>(content.clouds);
  if (content.empty_clouds > 0) {
    result.problems.push_back(
        text("%s: %.0f of %.0f clouds are empty", topic, static_cast<double>(content.empty_clouds), n));
  }
  if (content.clouds_without_time > 0) {
    result.remarks.push_back(
        text("%s: %.0f of %.0f clouds have no time per point: taken as 0.1 s in the order of the points",
             topic, static_cast<double>(content.clouds_without_time), n));
  }
}

/// Frames whose place the stages need.
void judgeFrames(const std::string& topic, const TopicContent& content, const std::set<std::string>& frames,
                 BagCheck& result) {
  const bool placed = content.kind == StreamKind::kPoints || content.kind == StreamKind::kCameraInfo ||
                      content.kind == StreamKind::kGnssFix || content.kind == StreamKind::kRadar ||
                      content.kind == StreamKind::kImu;
  if (!placed || frames.empty()) return;
  for (const std::string& frame : content.frames) {
    if (frames.count(frame) > 0) continue;
    result.problems.push_back(topic + ": frame '" + frame + "' has no place in /tf_static");
  }
}

/// Topics that begin late or end early against the others.
void judgeCoverage(BagCheck& result) {
  atlas::Stamp begin = atlas::kEndOfTime, end = atlas::kBeginOfTime;
  for (const auto& [topic, check] : result.topics) {
    if (check.last == 0) continue;
    begin = std::min(begin, check.first);
    end = std::max(end, check.last);
  }
  std::string late, early;
  for (const auto& [topic, check] : result.topics) {
    constexpr double kIntervals = 5.0, kAtLeast_s = 1.0;
    constexpr double kSparse_hz = 2.0;
    if (check.last == 0 || check.rate_hz < kSparse_hz) continue;
    const double allowed_s = std::max(kAtLeast_s, kIntervals / check.rate_hz);
    const double late_s = atlas::toSeconds(check.first - begin), early_s = atlas::toSeconds(end - check.last);
    if (late_s > allowed_s) late += (late.empty() ? "" : ", ") + text("%s %.1f s", topic, late_s);
    if (early_s > allowed_s) early += (early.empty() ? "" : ", ") + text("%s %.1f s", topic, early_s);
  }
  if (!late.empty()) result.problems.push_back("topics that begin after the others: " + late);
  if (!early.empty()) result.problems.push_back("topics that end before the others: " + early);
}

/// The replay reads a bag in order of recording and waits for a bounded time.
void judgeDelays(BagCheck& result) {
  double smallest_s = 1e18;
  for (const auto& [topic, check] : result.topics) {
    if (check.last != 0) smallest_s = std::min(smallest_s, check.smallest_delay_s);
  }
  const double allowed_s = atlas_ros::BagOptions().reorder_s;
  for (const auto& [topic, check] : result.topics) {
    if (check.last == 0 || check.largest_delay_s - smallest_s <= allowed_s) continue;
    result.problems.push_back(
        text("%s: lies up to %.2f s later in the bag than others of its stamp, a replay waits %.1f s", topic,
             check.largest_delay_s - smallest_s, allowed_s));
  }
}

void remarkOnImuRate(const std::map<std::string, TopicContent>& contents, BagCheck& result) {
  constexpr double kCoarse_hz = 50.0;  // a car turns by 1 deg in 20 ms
  for (const auto& [topic, check] : result.topics) {
    if (contents.at(topic).kind != StreamKind::kImu || check.rate_hz == 0 || check.rate_hz >= kCoarse_hz)
      continue;
    result.remarks.push_back(
        text("%s: %.1f Hz is slow for an IMU, the odometry between its samples is interpolated", topic,
             check.rate_hz));
  }
}

}  // namespace

void TopicStatistics::add(atlas::Stamp stamp, atlas::Stamp recorded) {
  if (stamp <= 0) {
    ++without_stamp_;
    ++messages_;
    return;
  }
  const atlas::Duration delay = recorded - stamp;
  const std::uint64_t stamped = messages_ - without_stamp_;
  if (stamped > 0) {
    const atlas::Duration interval = stamp - last_;
    if (interval < 0) ++backwards_;
    if (interval == 0) ++duplicates_;
    largest_gap_ = std::max(largest_gap_, interval);
    if (stamped % stride_ == 0) intervals_.push_back(interval);
  }
  smallest_ = stamped > 0 ? std::min(smallest_, stamp) : stamp;
  largest_ = stamped > 0 ? std::max(largest_, stamp) : stamp;
  smallest_delay_ = stamped > 0 ? std::min(smallest_delay_, delay) : delay;
  largest_delay_ = stamped > 0 ? std::max(largest_delay_, delay) : delay;
  if (stamped % stride_ == 0) delays_.push_back(delay);
  if (delays_.size() >= kMostSamples) thinOut();
  last_ = stamp;
  ++messages_;
}

/// Keeps every second sample from now on.
void TopicStatistics::thinOut() {
  for (auto* samples : {&intervals_, &delays_}) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples->size(); i += 2) (*samples)[kept++] = (*samples)[i];
    samples->resize(kept);
  }
  stride_ *= 2;
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
  check.without_stamp = without_stamp_;
  check.median_delay_s = medianSeconds(delays_);
  check.smallest_delay_s = atlas::toSeconds(smallest_delay_);
  check.largest_delay_s = atlas::toSeconds(largest_delay_);
  check.first = smallest_;
  check.last = largest_;
  return check;
}

std::string judgeGravity(const std::string& topic, const Eigen::Vector3d& mean_mps2, double mean_norm_mps2) {
  if (mean_norm_mps2 < 9.5 || mean_norm_mps2 > 10.5) {
    return text("%s: mean norm of the acceleration is %.2f m/s^2, not gravity (9.5 .. 10.5)", topic,
                mean_norm_mps2);
  }
  const std::string axis = axisOf(mean_mps2);
  if (axis == "+z") return "";
  if (axis == "-z") {
    return text("%s: the acceleration at rest points down (mean z %.2f m/s^2): sign inverted against REP-145",
                topic, mean_mps2.z());
  }
  return text("%s: gravity is not on the z axis (mean z %.2f of %.2f m/s^2", topic, mean_mps2.z(),
              mean_norm_mps2) +
         (axis.empty() ? "" : ", up is " + axis) + "): the IMU is mounted rotated";
}

std::vector<std::string> judgeTopic(const std::string& topic, const TopicCheck& check) {
  std::vector<std::string> problems;
  if (check.without_stamp > 0) {
    problems.push_back(
        text("%s: %.0f messages have no stamp", topic, static_cast<double>(check.without_stamp)));
  }
  if (check.backwards > 0)
    problems.push_back(text("%s: %.0f stamps go back", topic, static_cast<double>(check.backwards)));
  if (check.duplicates > 0)
    problems.push_back(text("%s: %.0f stamps occur twice", topic, static_cast<double>(check.duplicates)));
  constexpr double kSparse = 2.0;     // Hz; rarer messages may have gaps
  constexpr double kGapFactor = 5.0;  // of the usual interval
  if (check.rate_hz > kSparse && check.largest_gap_s > std::max(0.2, kGapFactor / check.rate_hz)) {
    problems.push_back(
        text("%s: a gap of %.2f s at usually %.1f Hz", topic, check.largest_gap_s, check.rate_hz));
  }
  if (check.messages > check.without_stamp && std::abs(check.median_delay_s) > 1.0) {
    problems.push_back(text("%s: recorded %.2f s after its stamps (median)", topic, check.median_delay_s));
  }
  return problems;
}

void judgeBag(const std::map<std::string, TopicContent>& contents, const std::set<std::string>& frames,
              BagCheck& check) {
  for (const auto& [topic, content] : contents) {
    judgeContent(topic, content, check);
    judgeFrames(topic, content, frames, check);
  }
  judgeCoverage(check);
  judgeDelays(check);
  remarkOnImuRate(contents, check);
  addMissing(contents, check);
}

}  // namespace atlas_loader
