// SPDX-License-Identifier: MIT
// Connects a core stage with the graph: subscriptions feed its inputs, its outputs and its progress are
// published, a new epoch replaces it by a fresh one. The protocol (StageHello, GraphStart, StageProgress) is
// described in atlas_msgs. Everything runs in the nodelet's one callback thread.
#pragma once

#include <atlas_msgs/GraphStart.h>
#include <atlas_msgs/HelloRequest.h>
#include <atlas_msgs/StageHello.h>
#include <atlas_msgs/StageProgress.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "atlas/base/local_graph.hpp"
#include "atlas/base/stage.hpp"
#include "atlas_ros/carried.hpp"
#include "atlas_ros/message_of.hpp"

namespace atlas_ros {

/// Unlimited: the player's pacing bounds the queues, a limit here would lose messages without a word.
constexpr int kKeepAll = 0;

class StageLink {
 public:
  /// `handle` gives the namespace of the graph's topics.
  StageLink(const ros::NodeHandle& handle, std::string stage_name);
  StageLink(const StageLink&) = delete;
  StageLink& operator=(const StageLink&) = delete;
  ~StageLink();

  /// Subscribes input `index` of the stage (see atlas::LocalGraph for the idea of a bus). A message that
  /// cannot be used is counted with its reason, in diagnostics and in the run's summary.
  template <class StageType, class T>
  void input(std::size_t index, const std::string& topic, std::function<void(StageType&, const T&)> push) {
    using Message = typename MessageOf<T>::Message;
    inputs_[index].topic = handle_.resolveName(topic);
    const auto deliver = [this, topic, push](const boost::shared_ptr<const Message>& message) {
      auto& stage = static_cast<StageType&>(*stage_);
      if (const T* carried = carriedBy<T>(message)) return push(stage, *carried);
      const auto value = MessageOf<T>::from(*message);
      if (value) {
        push(stage, *value);
      } else {
        unusable_.skip(topic, value.reason());
      }
    };
    subscribe<Message>(topic, [this, index, deliver](const boost::shared_ptr<const Message>& message) {
      guarded([&] { onMessage(index, [deliver, message] { deliver(message); }); });
    });
  }
  /// Advertises an output; the function publishes and counts, so that receivers know what to wait for.
  template <class T>
  std::function<void(const T&)> output(const std::string& topic, bool latch = false) {
    const std::string resolved = handle_.resolveName(topic);
    auto out = std::make_shared<Output>();
    out->topic = resolved;
    out->publisher = handle_.advertise<typename MessageOf<T>::Message>(topic, kKeepAll, onConnect(resolved),
                                                                       onDisconnect(resolved), {}, latch);
    outputs_.push_back(out);
    return [out](const T& value) {
      out->publisher.publish(carrying(MessageOf<T>::to(value), value));
      ++out->count;
    };
  }

  /// Call once, after all inputs and outputs are declared. The factory is called at the start of each epoch.
  void start(atlas::StageFactory factory);

  [[nodiscard]] const atlas::Stage* stage() const { return stage_.get(); }
  /// Called when the stage of an epoch has ended and everything is published (writers close their files in
  /// the stage itself).
  std::function<void()> on_end;

 private:
  struct PendingProgress {
    std::uint32_t epoch;
    std::uint64_t count;
    atlas::Stamp watermark;
  };
  struct Input {
    std::string topic;
    std::uint64_t count = 0;                    ///< delivered in this epoch
    std::deque<std::function<void()>> waiting;  ///< messages of an epoch that has not begun
    std::deque<PendingProgress> progress;
  };
  struct Output {
    std::string topic;
    ros::Publisher publisher;
    std::uint64_t count = 0;
  };

  struct Subscription {
    std::string topic;
    std::function<ros::Subscriber()> subscribe;
    ros::Subscriber subscriber;  ///< empty while the source wants the link to be made anew
  };

  template <class Message>
  void subscribe(const std::string& topic,
                 boost::function<void(const boost::shared_ptr<const Message>&)> callback) {
    const auto again = [this, topic, callback] {
      return handle_.subscribe<Message>(topic, kKeepAll, callback);
    };
    subscriptions_.push_back({handle_.resolveName(topic), again, again()});
  }
  ros::SubscriberStatusCallback onConnect(const std::string& topic);
  ros::SubscriberStatusCallback onDisconnect(const std::string& topic);
  void onHelloRequest(const atlas_msgs::HelloRequest& msg);
  void onMessage(std::size_t index, std::function<void()> push);
  void onGraphStart(const atlas_msgs::GraphStart& msg);
  void onProgress(const atlas_msgs::StageProgress& msg);
  void applyProgress(std::size_t index);
  void afterEvents();
  void publishProgress();
  void sayHello();
  void guarded(const std::function<void()>& body);

  ros::NodeHandle handle_;
  std::string name_;
  atlas::StageFactory factory_;
  std::unique_ptr<atlas::Stage> stage_;
  std::map<std::size_t, Input> inputs_;
  std::vector<std::shared_ptr<Output>> outputs_;
  atlas::Counters unusable_;
  std::vector<Subscription> subscriptions_;
  ros::Publisher hello_, progress_;
  ros::Subscriber hello_request_;
  std::multiset<std::string> links_;  ///< "<output topic> <process>" of every connection that is there
  std::uint32_t epoch_ = 0;
  std::atomic<bool> ready_{false};  ///< every subscription is made; no hello before: a run must not begin yet
  bool running_ = false;            ///< between GraphStart and the end of the epoch
  bool failed_ = false;
  std::string error_;
  diagnostic_updater::Updater
      diagnostics_;  ///< one status a second of event time; never an input of anything
  atlas::Stamp published_ = atlas::kBeginOfTime;
};

}  // namespace atlas_ros
