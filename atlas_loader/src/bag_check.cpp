// SPDX-License-Identifier: MIT
#include "bag_check.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "atlas_ros/event_messages.hpp"

namespace atlas_loader {
namespace {

bool hasPointTime(const sensor_msgs::PointCloud2& cloud) {
  static const std::set<std::string> kNames = {"time", "t", "timestamp", "offset_time", "time_stamp"};
  return std::any_of(cloud.fields.begin(), cloud.fields.end(),
                     [](const auto& field) { return kNames.count(field.name) > 0; });
}

/// As tf2 sees it: without the leading slash of tf1.
std::string frameName(const std::string& frame) { return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame; }

struct Acceleration {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double norm_sum = 0;
  std::uint64_t count = 0;
};

/// Takes in the messages of a bag one by one.
class BagContents {
 public:
  void add(const rosbag::MessageInstance& m) {
    const std::string topic = m.getTopic();
    types_[topic] = m.getDataType();
    const auto kind = atlas_ros::kindOf(topic, m.getDataType());
    if (!kind) return;
    contents_[topic].kind = *kind;
    atlas_ros::withMessageType(*kind, [&](auto* type) {
      using Message = std::remove_pointer_t<decltype(type)>;
      const auto message = m.instantiate<Message>();
      statistics_[topic].add(atlas_ros::stampOf(*message), atlas_ros::fromTime(m.getTime()));
      look(*kind, *message, topic);
    });
  }

  BagCheck judge() const {
    BagCheck result;
    for (const auto& [topic, type] : types_) {
      const auto content = contents_.find(topic);
      if (content == contents_.end()) {
        result.remarks.push_back(topic + " (" + type + ") is not used by the suite");
        continue;
      }
      const TopicCheck check = statistics_.at(topic).result(type);
      result.topics[topic] = check;
      if (content->second.kind == atlas::StreamKind::kStaticTransforms) continue;
      for (const std::string& problem : judgeTopic(topic, check)) result.problems.push_back(problem);
    }
    for (const auto& [topic, sum] : accelerations_) {
      const double n = static_cast<double>(sum.count);
      const std::string problem = judgeGravity(topic, sum.sum / n, sum.norm_sum / n);
      if (!problem.empty()) result.problems.push_back(problem);
    }
    judgeBag(contents_, frames_, result);
    return result;
  }

 private:
  template <class Message>
  void look(atlas::StreamKind kind, const Message& message, const std::string& topic) {
    TopicContent& content = contents_[topic];
    const auto payload = atlas_ros::toPayload(kind, message);
    if (!payload) {
      ++content.unusable[atlas::toString(payload.reason())];
    } else if constexpr (std::is_same_v<Message, sensor_msgs::Imu>) {
      if (kind == atlas::StreamKind::kImu) weigh(std::get<atlas::ImuSample>(*payload), topic);
    }
    if constexpr (std::is_same_v<Message, tf2_msgs::TFMessage>) {
      for (const auto& transform : message.transforms) {
        frames_.insert(frameName(transform.header.frame_id));
        frames_.insert(frameName(transform.child_frame_id));
      }
    } else {
      content.frames.insert(frameName(message.header.frame_id));
    }
    if constexpr (std::is_same_v<Message, sensor_msgs::PointCloud2>) {
      ++content.clouds;
      if (message.width == 0 || message.height == 0) ++content.empty_clouds;
      if (!hasPointTime(message)) ++content.clouds_without_time;
    }
  }

  void weigh(const atlas::ImuSample& sample, const std::string& topic) {
    Acceleration& sum = accelerations_[topic];
    sum.sum += sample.linear_acceleration_mps2;
    sum.norm_sum += sample.linear_acceleration_mps2.norm();
    ++sum.count;
  }

  std::map<std::string, std::string> types_;
  std::map<std::string, TopicStatistics> statistics_;
  std::map<std::string, TopicContent> contents_;
  std::map<std::string, Acceleration> accelerations_;
  std::set<std::string> frames_;
};

}  // namespace

BagCheck checkBag(const std::string& path) {
  rosbag::Bag bag;
  BagContents contents;
  try {
    bag.open(path, rosbag::bagmode::Read);
    rosbag::View view(bag);
    for (const rosbag::MessageInstance& m : view) contents.add(m);
  } catch (const rosbag::BagUnindexedException&) {
    throw std::runtime_error("bag " + path + " was not closed: run `rosbag reindex` on it");
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error("cannot read bag " + path + ": " + error.what());
  }
  return contents.judge();
}

}  // namespace atlas_loader
