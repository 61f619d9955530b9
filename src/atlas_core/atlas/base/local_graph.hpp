// SPDX-License-Identifier: MIT
// Stages connected inside one process: what topics do between nodelets, without topics. Single-threaded.
//
// A stage is bound to a graph by a function template bindXxx(bus, params) that declares its inputs and
// outputs once, for this graph and for ROS alike (atlas_ros::StageLink is the other kind of bus). A bus
// offers
//   bus.template input<StageType, T>(index, topic, push)   push(StageType&, const T&) hands a value to the
//   stage bus.template output<T>(topic)                          gives the std::function<void(const T&)> that
//   emits
// and bindXxx returns the factory of the stage: std::function<std::unique_ptr<Stage>()>.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "atlas/base/check.hpp"
#include "atlas/base/stage.hpp"

namespace atlas {

using StageFactory = std::function<std::unique_ptr<Stage>()>;

class LocalGraph {
 public:
  class Bus;
  using Bind = std::function<StageFactory(Bus&)>;

  /// Adds a stage; every stage that feeds it must have been added before.
  void add(const Bind& bind);

  /// Hands an event of a source (a topic that no stage produces) to the stages that want it.
  template <class T>
  void publish(const std::string& topic, const T& value) {
    const auto it = channels_.find(topic);
    if (it == channels_.end()) return;
    ATLAS_CHECK(it->second->type == typeid(T).name(), "topic " + topic + " carries another type");
    emit(*it->second, &value);
  }
  /// True when some stage subscribes the topic.
  [[nodiscard]] bool wants(const std::string& topic) const {
    const auto it = channels_.find(topic);
    return it != channels_.end() && !it->second->sinks.empty();
  }
  /// No further source event at or before `watermark`; carried on from stage to stage.
  void advance(Stamp watermark);
  /// No further source event at all: every stage flushes.
  void finish() { advance(kEndOfTime); }

  [[nodiscard]] std::vector<const Stage*> stages() const;

 private:
  struct Node {
    std::unique_ptr<Stage> stage;
  };
  struct Channel {
    std::string type;
    Node* producer = nullptr;  ///< null: a source
    std::vector<std::pair<Node*, std::size_t>> consumers;
    std::vector<std::function<void(const void*)>> sinks;
  };
  static void emit(const Channel& channel, const void* value) {
    for (const auto& sink : channel.sinks) sink(value);
  }
  Channel& channel(const std::string& topic, const char* type);
  static void advanceConsumers(const Channel& channel, Stamp watermark);

  std::map<std::string, std::unique_ptr<Channel>> channels_;
  std::vector<std::unique_ptr<Node>> nodes_;
};

class LocalGraph::Bus {
 public:
  Bus(LocalGraph& graph, Node& node) : graph_(graph), node_(node) {}

  template <class StageType, class T>
  void input(std::size_t index, const std::string& topic, std::function<void(StageType&, const T&)> push) {
    Channel& channel = graph_.channel(topic, typeid(T).name());
    channel.consumers.emplace_back(&node_, index);
    channel.sinks.push_back([node = &node_, push](const void* value) {
      push(static_cast<StageType&>(*node->stage), *static_cast<const T*>(value));
    });
  }
  template <class T>
  std::function<void(const T&)> output(const std::string& topic) {
    Channel& channel = graph_.channel(topic, typeid(T).name());
    ATLAS_CHECK(channel.producer == nullptr && channel.consumers.empty(),
                "topic " + topic + " is already in use");
    channel.producer = &node_;
    return [&channel](const T& value) { emit(channel, &value); };
  }

 private:
  LocalGraph& graph_;
  Node& node_;
};

}  // namespace atlas
