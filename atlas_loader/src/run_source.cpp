// SPDX-License-Identifier: MIT
#include "run_source.hpp"

#include <atlas_msgs/HelloRequest.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "atlas_ros/event_messages.hpp"
#include "atlas_ros/stage_link.hpp"

namespace atlas_loader {
namespace {
constexpr const char* kSourceName = "source";
constexpr atlas::Duration kPromiseStep = 20 * atlas::kMillisecond;  // of event time
constexpr std::chrono::milliseconds kPoll(100);
constexpr std::chrono::seconds kPatience(
    10);  // of wall time before a stage that everything waits for is named
constexpr std::chrono::seconds kRelinkAfter(5);  // of wall time before links that are missing are made anew
constexpr int kLettingGo = 5;                    // polls
}  // namespace

void validate(const RunSourceParams& params) {
  if (!(params.lead_s >= 0.5))
    throw std::invalid_argument("lead_s must be at least 0.5, got " + std::to_string(params.lead_s));
  if (params.stages.empty()) throw std::invalid_argument("stages: at least one stage is needed");
}

RunSource::RunSource(const ros::NodeHandle& handle, const RunSourceParams& params)
    : handle_(handle), params_(params) {
  validate(params);
  atlas_msgs::StageHello& self = hellos_[kSourceName];
  self.stage = kSourceName;
  self.process = ros::this_node::getName();
  self.inputs = {handle_.resolveName("progress")};
  self.outputs = {handle_.resolveName("progress"), handle_.resolveName("graph_start")};
  progress_ = handle_.advertise<atlas_msgs::StageProgress>("progress", 0, onConnect(self.outputs[0]),
                                                           onDisconnect(self.outputs[0]));
  start_ = handle_.advertise<atlas_msgs::GraphStart>("graph_start", 0, onConnect(self.outputs[1]),
                                                     onDisconnect(self.outputs[1]));
  connectHello();
  subscribeProgress();
}

void RunSource::connectHello() {
  hello_request_.shutdown();
  hello_sub_.shutdown();
  hello_request_ = handle_.advertise<atlas_msgs::HelloRequest>("hello_request", 0);
  hello_sub_ = handle_.subscribe("hello", atlas_ros::kKeepAll, &RunSource::onHello, this);
}

void RunSource::subscribeProgress() {
  progress_sub_ = handle_.subscribe("progress", atlas_ros::kKeepAll, &RunSource::onProgress, this);
}

ros::SubscriberStatusCallback RunSource::onConnect(const std::string& topic) {
  return [this, topic](const ros::SingleSubscriberPublisher& subscriber) {
    const std::lock_guard<std::mutex> lock(mutex_);
    hellos_[kSourceName].links.push_back(topic + " " + subscriber.getSubscriberName());
    changed_.notify_all();
  };
}

ros::SubscriberStatusCallback RunSource::onDisconnect(const std::string& topic) {
  return [this, topic](const ros::SingleSubscriberPublisher& subscriber) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<std::string>& links = hellos_[kSourceName].links;
    const auto link = std::find(links.begin(), links.end(), topic + " " + subscriber.getSubscriberName());
    if (link != links.end()) links.erase(link);
  };
}

void RunSource::advertise(const std::vector<atlas::StreamInfo>& streams) {
  streams_ = streams;
  counts_.assign(streams.size(), 0);
  for (const atlas::StreamInfo& stream : streams) {
    const std::string topic = handle_.resolveName(stream.topic);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      hellos_[kSourceName].outputs.push_back(topic);
    }
    atlas_ros::withMessageType(stream.kind, [&](auto* type) {
      using Message = std::remove_pointer_t<decltype(type)>;
      publishers_.push_back(
          handle_.advertise<Message>(stream.topic, 0, onConnect(topic), onDisconnect(topic)));
    });
  }
}

void RunSource::onHello(const atlas_msgs::StageHelloConstPtr& msg) {
  const std::lock_guard<std::mutex> lock(mutex_);
  hellos_[msg->stage] = *msg;
  changed_.notify_all();
}

void RunSource::onProgress(const atlas_msgs::StageProgressConstPtr& msg) {
  if (msg->stage == kSourceName) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (msg->failed && failure_.empty()) failure_ = msg->stage + ": " + msg->error;
  if (msg->epoch == epoch_) {
    StageReport& stage = stages_[msg->stage];
    stage.reached = msg->watermark_ns;
    stage.finished = msg->finished != 0;
    for (std::size_t i = 0; i < msg->counter_names.size(); ++i)
      stage.counters[msg->counter_names[i]] = msg->counter_values[i];
  }
  changed_.notify_all();
}

void RunSource::awaitGraph() {
  const auto begin = std::chrono::steady_clock::now();
  auto tried = begin;
  std::string missing;
  while (ros::ok()) {
    hello_request_.publish(atlas_msgs::HelloRequest());
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait_for(lock, kPoll);
      missing = missingInGraph(params_.stages, hellos_);
      requireOneProducer(hellos_);
    }
    if (missing.empty()) return;
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - begin).count() > params_.graph_timeout_s) break;
    if (now - tried < kRelinkAfter) continue;
    ROS_WARN("%s; connecting anew", missing.c_str());
    relink();
    tried = now;
  }
  throw std::runtime_error("the graph is not complete after " + std::to_string(params_.graph_timeout_s) +
                           " s: " + missing);
}

/// roscpp gives up a connection whose first request was lost, so the subscriber has to begin again. Stages of
/// one process share a connection: all of them let go before one subscribes again.
void RunSource::relink() {
  atlas_msgs::HelloRequest request;
  bool own = false, silent = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const MissingLink& link : missingLinks(hellos_)) {
      own = own || link.consumer == kSourceName;
      request.relink.push_back(link.topic + " " + link.process);
    }
    for (const std::string& stage : params_.stages) silent = silent || hellos_.count(stage) == 0;
  }
  if (silent) connectHello();
  if (own) progress_sub_.shutdown();
  for (int i = 0; i < kLettingGo; ++i) {
    hello_request_.publish(request);
    std::this_thread::sleep_for(kPoll);
  }
  if (own) subscribeProgress();
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto hello = hellos_.begin(); hello != hellos_.end();)  // what they said is out of date
    hello = hello->first == kSourceName ? std::next(hello) : hellos_.erase(hello);
}

std::vector<std::string> RunSource::wantedTopics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::set<std::string> wanted, produced;
  for (const auto& [name, hello] : hellos_) {
    wanted.insert(hello.inputs.begin(), hello.inputs.end());
    produced.insert(hello.outputs.begin(), hello.outputs.end());
  }
  const std::string ns = handle_.getNamespace() + "/";
  std::vector<std::string> topics;
  for (const std::string& topic : wanted) {
    if (produced.count(topic) == 0 && topic.compare(0, ns.size(), ns) == 0)
      topics.push_back(topic.substr(ns.size()));
  }
  return topics;
}

void RunSource::begin(std::uint32_t epoch) {
  atlas_msgs::GraphStart msg;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    epoch_ = epoch;
    stages_.clear();
    for (const std::string& stage : params_.stages) stages_[stage];
    std::set<std::string> topics;
    for (const auto& [name, hello] : hellos_) topics.insert(hello.outputs.begin(), hello.outputs.end());
    msg.topics.assign(topics.begin(), topics.end());
  }
  msg.epoch = epoch;
  std::fill(counts_.begin(), counts_.end(), 0);
  promised_ = atlas::kBeginOfTime;
  start_.publish(msg);
}

atlas::Stamp RunSource::slowest() const {
  atlas::Stamp result = atlas::kEndOfTime;
  for (const auto& [name, stage] : stages_) result = std::min(result, stage.reached);
  return result;
}

std::string RunSource::slowestInWords() const {
  const atlas::Stamp behind = slowest();
  std::string names;
  for (const auto& [name, stage] : stages_) {
    if (stage.reached == behind) names += (names.empty() ? "" : ", ") + name;
  }
  if (behind == atlas::kBeginOfTime) return names + " (no progress yet)";
  return names + " (" + std::to_string(atlas::toSeconds(promised_ - behind)) + " s behind)";
}

bool RunSource::awaitStages(const std::function<bool()>& condition) {
  std::unique_lock<std::mutex> lock(mutex_);
  auto said = std::chrono::steady_clock::now();
  while (failure_.empty() && ros::ok()) {
    if (condition()) return true;
    changed_.wait_for(lock, kPoll);
    if (std::chrono::steady_clock::now() - said < kPatience) continue;
    said = std::chrono::steady_clock::now();
    ROS_WARN("waiting for the slowest stage: %s", slowestInWords().c_str());
  }
  return false;
}

bool RunSource::publish(const atlas::Event& event) {
  const bool is_static = streams_.at(event.stream).kind == atlas::StreamKind::kStaticTransforms;
  if (is_static) {  // counts before every other event, so no promise may be made before it
    if (promised_ != atlas::kBeginOfTime) throw std::logic_error("tf_static after the first event");
    send(event);
    return true;
  }
  if (promised_ == atlas::kBeginOfTime || event.stamp - 1 >= promised_ + kPromiseStep)
    promise(event.stamp - 1);
  const atlas::Duration lead = atlas::fromSeconds(params_.lead_s);
  // Before the first progress of a stage it has reached nothing: the lead then counts from the first promise.
  const auto close_enough = [&] {
    const atlas::Stamp behind = slowest();
    return behind == atlas::kBeginOfTime
               ? promised_ == atlas::kBeginOfTime || event.stamp < first_promise_ + lead
               : event.stamp - lead <= behind;
  };
  bool wait = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wait = !close_enough();
  }
  if (wait) promise(event.stamp - 1);
  if (!awaitStages(close_enough)) return false;
  send(event);
  return true;
}

void RunSource::send(const atlas::Event& event) {
  atlas_ros::withMessage(streams_.at(event.stream).kind, event,
                         [&](const auto& message) { publishers_.at(event.stream).publish(message); });
  ++counts_.at(event.stream);
}

void RunSource::promise(atlas::Stamp watermark) {
  if (watermark <= promised_) return;
  if (promised_ == atlas::kBeginOfTime) first_promise_ = watermark;
  promised_ = watermark;
  atlas_msgs::StageProgress msg;
  msg.stage = kSourceName;
  msg.epoch = epoch_;
  msg.watermark_ns = watermark;
  msg.finished = watermark == atlas::kEndOfTime;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    msg.topics.push_back(handle_.resolveName(streams_[i].topic));
    msg.counts.push_back(counts_[i]);
  }
  progress_.publish(msg);
}

bool RunSource::end() {
  promise(atlas::kEndOfTime);
  return awaitStages([this] {
    return std::all_of(stages_.begin(), stages_.end(),
                       [](const auto& entry) { return entry.second.finished; });
  });
}

std::map<std::string, RunSource::StageReport> RunSource::stages() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return stages_;
}

std::map<std::string, std::uint64_t> RunSource::published() const {
  std::map<std::string, std::uint64_t> result;
  for (std::size_t i = 0; i < streams_.size(); ++i) result[streams_[i].topic] = counts_[i];
  return result;
}

std::string RunSource::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

}  // namespace atlas_loader
