// SPDX-License-Identifier: MIT
// Judges a bag before anyone blames the code (the idea of cartographer_ros' rosbag_validate): order, gaps, rates, gravity, missing
// topics, stamps against the time of recording.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "atlas/base/time.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas_loader {

struct TopicCheck {
  std::string datatype;
  std::uint64_t messages = 0;
  double rate_hz = 0;          ///< from the median interval
  double largest_gap_s = 0;
  std::uint64_t backwards = 0;   ///< stamps before their predecessor
  std::uint64_t duplicates = 0;  ///< stamps equal to their predecessor
  double median_delay_s = 0;     ///< time of recording minus stamp
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
  atlas::Stamp last_ = 0;
  std::uint64_t messages_ = 0, backwards_ = 0, duplicates_ = 0;
  atlas::Duration largest_gap_ = 0;
  std::vector<atlas::Duration> intervals_, delays_;  ///< thinned: bounded memory
  std::uint64_t stride_ = 1;
};

/// What the mean of the accelerometer says: empty when it looks like gravity pointing up at rest, else the problem in words.
std::string judgeGravity(const std::string& topic, const Eigen::Vector3d& mean_mps2, double mean_norm_mps2);

/// What the figures of a topic say, in words; empty when fine. Messages rarer than sparse_hz may have gaps.
std::vector<std::string> judgeTopic(const std::string& topic, const TopicCheck& check);

/// Throws std::runtime_error naming the file when it cannot be read.
BagCheck checkBag(const std::string& path);

}  // namespace atlas_loader
