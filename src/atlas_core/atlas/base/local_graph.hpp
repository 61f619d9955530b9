// SPDX-License-Identifier: MIT
// Stages connected inside one process: what topics do between nodelets, without topics.
//
// One thread does everything, or the stages are divided into groups, each with a thread of its own. A group
// is handed its calls by the group before it (the first one by the caller), so every stage sees the same
// calls in the same order, whatever the number of threads.
//
// A stage is bound to a graph by a function template bindXxx(bus, params) that declares its inputs and
// outputs once, for this graph and for ROS alike (atlas_ros::StageLink is the other kind of bus). A bus
// offers
//   bus.template input<StageType, T>(index, topic, push)   push(StageType&, const T&) hands a value to the
//   stage bus.template output<T>(topic)                          gives the std::function<void(const T&)> that
//   emits
// and bindXxx returns the factory of the stage: std::function<std::unique_ptr<Stage>()>.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "atlas/base/check.hpp"
#include "atlas/base/graph_thread.hpp"
#include "atlas/base/stage.hpp"

namespace atlas {

using StageFactory = std::function<std::unique_ptr<Stage>()>;

class LocalGraph {
 public:
  class Bus;
  using Bind = std::function<StageFactory(Bus&)>;
  enum class Threads { kOne, kSeveral };

  explicit LocalGraph(Threads threads = Threads::kOne) : several_(threads == Threads::kSeveral) {}
  /// What threads have not begun is dropped.
  ~LocalGraph();
  LocalGraph(const LocalGraph&) = delete;
  LocalGraph& operator=(const LocalGraph&) = delete;

  /// The stages added from here on have a thread of their own; nothing happens with Threads::kOne.
  void beginThread();
  /// Adds a stage; every stage that feeds it must have been added before.
  void add(const Bind& bind);

  // These three may throw what a stage of another thread has thrown.
  /// Hands an event of a source (a topic that no stage produces) to the stages that want it.
  template <class T>
  void publish(const std::string& topic, const T& value) {
    const auto it = channels_.find(topic);
    if (it == channels_.end()) return;
    ATLAS_CHECK(it->second->type == typeid(T).name(), "topic " + topic + " carries another type");
    emit(*it->second, kCaller, value);
  }
  /// True when some stage subscribes the topic.
  [[nodiscard]] bool wants(const std::string& topic) const {
    const auto it = channels_.find(topic);
    return it != channels_.end() && !it->second->sinks.empty();
  }
  /// No further source event at or before `watermark`; carried on from stage to stage.
  void advance(Stamp watermark);
  /// No further source event at all: every stage flushes. All of it is done afterwards.
  void finish();

  /// Not while threads are at work: before the first event or after finish().
  [[nodiscard]] std::vector<const Stage*> stages() const;

 private:
  static constexpr std::size_t kCaller = 0;  ///< number of the thread that calls publish()
  struct Node {
    std::unique_ptr<Stage> stage;
    std::size_t thread = kCaller;
  };
  struct Sink {
    std::size_t thread;
    std::function<void(const void*)> push;
  };
  struct Channel {
    std::string type;
    Node* producer = nullptr;  ///< null: a source
    std::vector<std::pair<Node*, std::size_t>> consumers;
    std::deque<Sink> sinks;  ///< their addresses stay
  };
  /// In thread `from`, which is never behind that of a sink.
  template <class T>
  void emit(const Channel& channel, std::size_t from, const T& value) {
    std::shared_ptr<const T> copy;
    for (const Sink& sink : channel.sinks) {
      if (sink.thread == from) {
        sink.push(&value);
        continue;
      }
      if (!copy) copy = std::make_shared<const T>(value);
      send(from, sink.thread, [&sink, copy] { sink.push(copy.get()); });
    }
  }
  /// From thread to thread, so that it overtakes nothing.
  void send(std::size_t from, std::size_t to, GraphThread::Work work);
  Channel& channel(const std::string& topic, const char* type);
  void advanceConsumers(const Channel& channel, std::size_t from, Stamp watermark);
  /// Passes the progress of the stages of a thread on, then lets the next thread do the same.
  void passProgress(std::size_t thread);

  bool several_;
  std::map<std::string, std::unique_ptr<Channel>> channels_;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::vector<std::unique_ptr<GraphThread>> threads_;  ///< numbered from 1
};

class LocalGraph::Bus {
 public:
  Bus(LocalGraph& graph, Node& node) : graph_(graph), node_(node) {}

  template <class StageType, class T>
  void input(std::size_t index, const std::string& topic, std::function<void(StageType&, const T&)> push) {
    Channel& channel = graph_.channel(topic, typeid(T).name());
    channel.consumers.emplace_back(&node_, index);
    channel.sinks.push_back({node_.thread, [node = &node_, push](const void* value) {
                               push(static_cast<StageType&>(*node->stage), *static_cast<const T*>(value));
                             }});
  }
  template <class T>
  std::function<void(const T&)> output(const std::string& topic) {
    Channel& channel = graph_.channel(topic, typeid(T).name());
    ATLAS_CHECK(channel.producer == nullptr && channel.consumers.empty(),
                "topic " + topic + " is already in use");
    channel.producer = &node_;
    return [&graph = graph_, &channel, thread = node_.thread](const T& value) {
      graph.emit(channel, thread, value);
    };
  }

 private:
  LocalGraph& graph_;
  Node& node_;
};

}  // namespace atlas
