// SPDX-License-Identifier: MIT
#include "graph_check.hpp"

#include <algorithm>
#include <stdexcept>

namespace atlas_loader {
namespace {

bool contains(const std::vector<std::string>& values, const std::string& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

}  // namespace

std::vector<MissingLink> missingLinks(const Hellos& hellos) {
  std::vector<MissingLink> result;
  for (const auto& [consumer_name, consumer] : hellos) {
    for (const std::string& topic : consumer.inputs) {
      for (const auto& [producer_name, producer] : hellos) {
        if (!contains(producer.outputs, topic) || producer.process == consumer.process) continue;
        if (contains(producer.links, topic + " " + consumer.process)) continue;
        result.push_back({topic, producer_name, consumer_name, consumer.process});
      }
    }
  }
  return result;
}

std::string missingInGraph(const std::vector<std::string>& expected_stages, const Hellos& hellos) {
  for (const std::string& stage : expected_stages) {
    if (hellos.count(stage) == 0) return "stage " + stage + " has not said hello";
  }
  const std::vector<MissingLink> links = missingLinks(hellos);
  if (links.empty()) return "";
  return links[0].consumer + " is not linked to " + links[0].topic + " of " + links[0].producer;
}

void requireOneProducer(const Hellos& hellos) {
  std::map<std::string, std::string> producers;
  const std::string everyone = "/progress";
  for (const auto& [stage, hello] : hellos) {
    for (const std::string& topic : hello.outputs) {
      const bool shared = topic.size() >= everyone.size() &&
                          topic.compare(topic.size() - everyone.size(), everyone.size(), everyone) == 0;
      const auto [known, fresh] = producers.emplace(topic, stage);
      if (!shared && !fresh)
        throw std::runtime_error(topic + " comes from " + known->second + " and from " + stage +
                                 "; a topic has one producer");
    }
  }
}

}  // namespace atlas_loader
