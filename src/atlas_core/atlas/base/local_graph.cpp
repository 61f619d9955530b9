// SPDX-License-Identifier: MIT
#include "atlas/base/local_graph.hpp"

#include <set>
#include <utility>

namespace atlas {
namespace {
/// Bounds the memory of what waits between two threads. Advancing by 5 ms of event time, 0.2 s of it: longer
/// than any stage is busy with one input.
constexpr std::size_t kMostSteps = 40;
}  // namespace

LocalGraph::~LocalGraph() {
  for (auto& thread : threads_) thread.reset();  // in their order: none hands work to one that is gone
}

void LocalGraph::beginThread() {
  if (several_) threads_.push_back(std::make_unique<GraphThread>(kMostSteps));
}

void LocalGraph::add(const Bind& bind) {
  nodes_.push_back(std::make_unique<Node>());
  nodes_.back()->thread = threads_.size();
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

void LocalGraph::send(std::size_t from, std::size_t to, GraphThread::Work work) {
  const std::size_t next = from + 1;
  GraphThread& thread = *threads_[next - 1];
  if (to == next) {
    thread.post(std::move(work));
  } else {
    thread.post([this, next, to, work = std::move(work)] { send(next, to, work); });
  }
}

void LocalGraph::advanceConsumers(const Channel& channel, std::size_t from, Stamp watermark) {
  for (const auto& [consumer, input_index] : channel.consumers) {
    Node* const node = consumer;
    const std::size_t input = input_index;
    if (node->thread == from) {
      node->stage->advance(input, watermark);
    } else {
      send(from, node->thread, [node, input, watermark] { node->stage->advance(input, watermark); });
    }
  }
}

void LocalGraph::passProgress(std::size_t thread) {
  for (const auto& node :
       nodes_) {  // in order of the data path: a stage's progress is final before it is passed on
    if (node->thread != thread) continue;
    for (const auto& [topic, channel] : channels_) {
      if (channel->producer == node.get()) advanceConsumers(*channel, thread, node->stage->progress());
    }
  }
  if (thread < threads_.size()) threads_[thread]->postStep([this, thread] { passProgress(thread + 1); });
}

void LocalGraph::advance(Stamp watermark) {
  for (const auto& [topic, channel] : channels_) {
    if (channel->producer == nullptr) advanceConsumers(*channel, kCaller, watermark);
  }
  passProgress(kCaller);
}

void LocalGraph::finish() {
  advance(kEndOfTime);
  for (const auto& thread : threads_) thread->wait();  // one after the other: each hands work to the next
}

std::vector<const Stage*> LocalGraph::stages() const {
  std::vector<const Stage*> result;
  for (const auto& node : nodes_) result.push_back(node->stage.get());
  return result;
}

}  // namespace atlas
