// SPDX-License-Identifier: MIT
// Judges a bag before anyone blames the code (the idea of cartographer_ros' rosbag_validate): order, gaps,
// rates, gravity, missing topics and frames, unusable messages, stamps against the time of recording.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "atlas/base/time.hpp"
#include "atlas/sensor/record_reader.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas_loader {

struct TopicCheck {
  std::string datatype;
  std::uint64_t messages = 0;
  double rate_hz = 0;  ///< from the median interval
  double largest_gap_s = 0;
  std::uint64_t backwards = 0;   ///< stamps before their predecessor
  std::uint64_t duplicates = 0;  ///< stamps equal to their predecessor
  std::uint64_t without_stamp = 0;
  double median_delay_s = 0;  ///< time of recording minus stamp
  double smallest_delay_s = 0, largest_delay_s = 0;
  atlas::Stamp first = 0, last = 0;  ///< smallest and largest stamp; both 0 without any
};

/// What the messages of a topic hold.
struct TopicContent {
  atlas::StreamKind kind = atlas::StreamKind::kImu;
  std::map<std::string, std::uint64_t> unusable;  ///< reason -> messages that the suite leaves out
  std::set<std::string> frames;
  std::uint64_t clouds = 0, empty_clouds = 0, clouds_without_time = 0;
};

struct BagCheck {
  std::map<std::string, TopicCheck> topics;
  std::vector<std::string> problems;  ///< something that will spoil results
  std::vector<std::string> remarks;   ///< something to know
};

/// Collects the stamps of one topic.
class TopicStatistics {
 public:
  void add(atlas::Stamp stamp, atlas::Stamp recorded);
  [[nodiscard]] TopicCheck result(const std::string& datatype) const;

 private:
  void thinOut();

  atlas::Stamp last_ = 0, smallest_ = 0, largest_ = 0;
  std::uint64_t messages_ = 0, backwards_ = 0, duplicates_ = 0, without_stamp_ = 0;
  atlas::Duration largest_gap_ = 0, smallest_delay_ = 0, largest_delay_ = 0;
  std::vector<atlas::Duration> intervals_, delays_;  ///< thinned: bounded memory
  std::uint64_t stride_ = 1;
};

/// What the mean of the accelerometer says: empty when it looks like gravity pointing up at rest, else the
/// problem in words.
std::string judgeGravity(const std::string& topic, const Eigen::Vector3d& mean_mps2, double mean_norm_mps2);

/// What the figures of a topic say, in words; empty when fine. Messages rarer than 2 Hz may have gaps.
std::vector<std::string> judgeTopic(const std::string& topic, const TopicCheck& check);

/// What contents and figures of all topics say together. `frames` are those of /tf_static.
void judgeBag(const std::map<std::string, TopicContent>& contents, const std::set<std::string>& frames,
              BagCheck& check);

/// Throws std::runtime_error naming the file when it cannot be read.
BagCheck checkBag(const std::string& path);

}  // namespace atlas_loader
