// SPDX-License-Identifier: MIT
#include "atlas/base/local_graph.hpp"

#include <set>

namespace atlas {

void LocalGraph::add(const Bind& bind) {
  nodes_.push_back(std::make_unique<Node>());
  Bus bus(*this, *nodes_.back());
  const StageFactory factory = bind(bus);
  nodes_.back()->stage = factory();
  std::set<std::size_t> bound;
  for (const auto& [topic, channel] : channels_) {
    for (const auto& [node, input] : channel->consumers) {
      if (node == nodes_.back().get()) bound.insert(input);
    }
  }
  for (std::size_t i = 0; i < nodes_.back()->stage->inputs(); ++i) {
    if (bound.count(i) == 0) nodes_.back()->stage->finish(i);  // not bound to any topic
  }
}

LocalGraph::Channel& LocalGraph::channel(const std::string& topic, const char* type) {
  auto& channel = channels_[topic];
  if (!channel) {
    channel = std::make_unique<Channel>();
    channel->type = type;
  }
  ATLAS_CHECK(channel->type == type, "topic " + topic + " carries another type");
  return *channel;
}

void LocalGraph::advanceConsumers(const Channel& channel, Stamp watermark) {
  for (const auto& [node, input] : channel.consumers) node->stage->advance(input, watermark);
}

void LocalGraph::advance(Stamp watermark) {
  for (const auto& [topic, channel] : channels_) {
    if (channel->producer == nullptr) advanceConsumers(*channel, watermark);
  }
  for (const auto& node :
       nodes_) {  // in order of the data path: a stage's progress is final before it is passed on
    for (const auto& [topic, channel] : channels_) {
      if (channel->producer == node.get()) advanceConsumers(*channel, node->stage->progress());
    }
  }
}

std::vector<const Stage*> LocalGraph::stages() const {
  std::vector<const Stage*> result;
  for (const auto& node : nodes_) result.push_back(node->stage.get());
  return result;
}

}  // namespace atlas
