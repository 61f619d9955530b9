// SPDX-License-Identifier: MIT
// The source's half of the run protocol (atlas_msgs): waits until the graph is complete, publishes events,
// never runs ahead of the slowest stage by more than a bounded span of event time, ends the run when every
// stage has ended. Callbacks come from the nodelet's thread, publish() and the waits from the one thread that
// reads the record.
#pragma once

#include <atlas_msgs/GraphStart.h>
#include <atlas_msgs/StageProgress.h>
#include <ros/ros.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "atlas/sensor/record_reader.hpp"
#include "graph_check.hpp"

namespace atlas_loader {

struct RunSourceParams {
  std::vector<std::string> stages;  ///< names that must be there before the first event
  double lead_s = 2.0;              ///< event time that the source may be ahead of the slowest stage
  double graph_timeout_s = 60.0;    ///< wall time to wait for the stages
};
/// Throws std::invalid_argument naming the field and its value.
void validate(const RunSourceParams& params);

class RunSource {
 public:
  RunSource(const ros::NodeHandle& handle, const RunSourceParams& params);

  /// Advertises one topic per stream, in the graph's namespace.
  void advertise(const std::vector<atlas::StreamInfo>& streams);
  /// Topics (without the graph's namespace) that stages want and no stage produces; known once every stage
  /// has said hello.
  [[nodiscard]] std::vector<std::string> wantedTopics() const;
  /// Blocks until every stage is there and linked, makes links anew that do not come about; throws
  /// std::runtime_error that says what is missing.
  void awaitGraph();
  /// Starts epoch n (0, 1, ...): the stages begin afresh.
  void begin(std::uint32_t epoch);
  /// Publishes, blocking while the slowest stage is too far behind. False when the run has failed or ROS
  /// shuts down.
  bool publish(const atlas::Event& event);
  /// Promise to the stages: nothing at or before `watermark` follows.
  void promise(atlas::Stamp watermark);
  /// Ends the streams and waits until every stage has ended. False when the run has failed or ROS shuts down.
  bool end();

  struct StageReport {
    bool finished = false;
    atlas::Stamp reached = atlas::kBeginOfTime;
    std::map<std::string, std::uint64_t> counters;
  };
  [[nodiscard]] std::map<std::string, StageReport> stages() const;
  [[nodiscard]] std::map<std::string, std::uint64_t> published() const;
  [[nodiscard]] std::string failure() const;

 private:
  void onHello(const atlas_msgs::StageHelloConstPtr& msg);
  void onProgress(const atlas_msgs::StageProgressConstPtr& msg);
  ros::SubscriberStatusCallback onConnect(const std::string& topic);
  ros::SubscriberStatusCallback onDisconnect(const std::string& topic);
  void connectHello();
  void subscribeProgress();
  void relink();
  void send(const atlas::Event& event);
  bool awaitStages(const std::function<bool()>& condition);
  [[nodiscard]] atlas::Stamp slowest() const;
  [[nodiscard]] std::string slowestInWords() const;

  ros::NodeHandle handle_;
  RunSourceParams params_;
  std::vector<atlas::StreamInfo> streams_;
  std::vector<ros::Publisher> publishers_;
  std::vector<std::uint64_t> counts_;
  ros::Publisher progress_, start_, hello_request_;
  ros::Subscriber hello_sub_, progress_sub_;
  std::uint32_t epoch_ = 0;
  atlas::Stamp promised_ = atlas::kBeginOfTime, first_promise_ = atlas::kBeginOfTime;

  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  Hellos hellos_;  ///< the source itself under its own name
  std::map<std::string, StageReport> stages_;
  std::string failure_;
};

}  // namespace atlas_loader
