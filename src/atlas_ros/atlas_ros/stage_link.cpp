// SPDX-License-Identifier: MIT
#include "atlas_ros/stage_link.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "atlas_ros/stage_diagnostics.hpp"

namespace atlas_ros {
namespace {
/// Progress is published in steps of event time: fine enough for the pacing, cheap enough at hundreds of Hz.
constexpr atlas::Duration kProgressStep = 20 * atlas::kMillisecond;
}  // namespace

StageLink::StageLink(const ros::NodeHandle& handle, std::string stage_name)
    : handle_(handle),
      name_(std::move(stage_name)),
      diagnostics_(handle_, handle_, handle_.resolveName(name_)) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("stage", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    describeStage(stage_.get(), unusable_, error_, status);
  });
}

StageLink::~StageLink() = default;

ros::SubscriberStatusCallback StageLink::onConnect(const std::string& topic) {
  return [this, topic](const ros::SingleSubscriberPublisher& subscriber) {
    links_.insert(topic + " " + subscriber.getSubscriberName());
    sayHello();
  };
}

ros::SubscriberStatusCallback StageLink::onDisconnect(const std::string& topic) {
  return [this, topic](const ros::SingleSubscriberPublisher& subscriber) {
    const auto link = links_.find(topic + " " + subscriber.getSubscriberName());
    if (link != links_.end()) links_.erase(link);
    sayHello();
  };
}

void StageLink::start(atlas::StageFactory factory) {
  factory_ = std::move(factory);
  hello_ = handle_.advertise<atlas_msgs::StageHello>("hello", kKeepAll);
  const std::string progress = handle_.resolveName("progress");
  progress_ = handle_.advertise<atlas_msgs::StageProgress>("progress", kKeepAll, onConnect(progress),
                                                           onDisconnect(progress));
  subscribe<atlas_msgs::StageProgress>(
      "progress", [this](const atlas_msgs::StageProgressConstPtr& m) { guarded([&] { onProgress(*m); }); });
  subscribe<atlas_msgs::GraphStart>(
      "graph_start", [this](const atlas_msgs::GraphStartConstPtr& m) { guarded([&] { onGraphStart(*m); }); });
  hello_request_ = handle_.subscribe<atlas_msgs::HelloRequest>(
      "hello_request", kKeepAll,
      boost::function<void(const atlas_msgs::HelloRequestConstPtr&)>(
          [this](const atlas_msgs::HelloRequestConstPtr& m) { onHelloRequest(*m); }));
  ready_ = true;  // the source asks until it has heard every stage
}

void StageLink::onHelloRequest(const atlas_msgs::HelloRequest& msg) {
  if (!ready_) return;
  for (Subscription& subscription : subscriptions_) {
    const std::string link = subscription.topic + " " + ros::this_node::getName();
    const bool let_go = std::find(msg.relink.begin(), msg.relink.end(), link) != msg.relink.end();
    if (let_go) {
      subscription.subscriber.shutdown();
    } else if (!subscription.subscriber) {
      subscription.subscriber = subscription.subscribe();
    }
  }
  sayHello();
}

void StageLink::sayHello() {
  if (!ready_) return;  // called by a connection while start() still runs in the loading thread
  atlas_msgs::StageHello msg;
  msg.stage = name_;
  msg.process = ros::this_node::getName();
  for (const auto& [index, input] : inputs_) msg.inputs.push_back(input.topic);
  msg.inputs.push_back(handle_.resolveName("progress"));
  msg.inputs.push_back(handle_.resolveName("graph_start"));
  for (const auto& output : outputs_) msg.outputs.push_back(output->topic);
  msg.outputs.push_back(handle_.resolveName("progress"));
  msg.links.assign(links_.begin(), links_.end());
  hello_.publish(msg);
}

void StageLink::onGraphStart(const atlas_msgs::GraphStart& msg) {
  if (running_ || failed_) return;
  epoch_ = msg.epoch;
  running_ = true;
  published_ = atlas::kBeginOfTime;
  for (const auto& output : outputs_) output->count = 0;
  unusable_ = {};
  stage_ = factory_();
  const std::set<std::string> produced(msg.topics.begin(), msg.topics.end());
  for (auto& [index, input] : inputs_) input.count = 0;
  for (std::size_t i = 0; i < stage_->inputs(); ++i) {
    if (inputs_.count(i) == 0) stage_->finish(i);  // not bound to any topic
  }
  for (auto& [index, input] : inputs_) {
    if (produced.count(input.topic) == 0) stage_->finish(index);
    std::deque<std::function<void()>> waiting;
    waiting.swap(input.waiting);
    for (auto& push : waiting) onMessage(index, std::move(push));
    applyProgress(index);
  }
  afterEvents();
}

void StageLink::onMessage(std::size_t index, std::function<void()> push) {
  Input& input = inputs_.at(index);
  if (!running_) {
    input.waiting.push_back(std::move(push));
    return;
  }
  ++input.count;
  push();
  applyProgress(index);
  afterEvents();
}

void StageLink::onProgress(const atlas_msgs::StageProgress& msg) {
  for (std::size_t i = 0; i < msg.topics.size(); ++i) {
    for (auto& [index, input] : inputs_) {
      if (input.topic != msg.topics[i]) continue;
      input.progress.push_back({msg.epoch, msg.counts[i], msg.watermark_ns});
      applyProgress(index);
    }
  }
  afterEvents();
}

void StageLink::applyProgress(std::size_t index) {
  Input& input = inputs_.at(index);
  while (running_ && !input.progress.empty()) {
    const PendingProgress next = input.progress.front();
    if (next.epoch > epoch_ || (next.epoch == epoch_ && next.count > input.count)) return;
    input.progress.pop_front();
    if (next.epoch == epoch_) stage_->advance(index, next.watermark);
  }
}

void StageLink::afterEvents() {
  if (!running_ || failed_) return;
  const atlas::Stamp reached = stage_->progress();
  const bool ended = stage_->ended();
  const bool due =
      reached > published_ && (published_ == atlas::kBeginOfTime || reached - published_ >= kProgressStep);
  if (!due && !ended) return;
  published_ = reached;
  if (ended && on_end) on_end();
  publishProgress();
  if (ended) running_ = false;
  if (ended) diagnostics_.force_update();
  if (!ended) diagnostics_.update();
}

void StageLink::publishProgress() {
  atlas_msgs::StageProgress msg;
  msg.stage = name_;
  msg.epoch = epoch_;
  msg.watermark_ns = published_;
  msg.finished = stage_->ended();
  for (const auto& output : outputs_) {
    msg.topics.push_back(output->topic);
    msg.counts.push_back(output->count);
  }
  if (stage_->ended()) {
    for (const auto& [name, value] : countsOf(*stage_, unusable_)) {
      msg.counter_names.push_back(name);
      msg.counter_values.push_back(value);
    }
  }
  progress_.publish(msg);
}

void StageLink::guarded(const std::function<void()>& body) {
  if (failed_) return;
  try {
    body();
  } catch (const std::exception& error) {
    failed_ = true;
    error_ = error.what();
    diagnostics_.force_update();
    ROS_FATAL("%s: %s; the run fails", name_.c_str(), error.what());
    atlas_msgs::StageProgress msg;
    msg.stage = name_;
    msg.epoch = epoch_;
    msg.watermark_ns = published_;
    msg.failed = true;
    msg.error = error.what();
    progress_.publish(msg);
  }
}

}  // namespace atlas_ros
