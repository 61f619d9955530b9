// SPDX-License-Identifier: MIT
// Is the graph of a run complete? Every expected stage has said hello, and every link between two processes
// is confirmed by its publishing side. Pure, for tests.
#pragma once

#include <atlas_msgs/StageHello.h>

#include <map>
#include <string>
#include <vector>

namespace atlas_loader {

using Hellos = std::map<std::string, atlas_msgs::StageHello>;  ///< by stage

struct MissingLink {
  std::string topic, producer, consumer;  ///< resolved topic, names of the two stages
  std::string process;                    ///< of the consumer
};

/// Topics of one stage that another stage wants, in another process, without a confirmed connection.
std::vector<MissingLink> missingLinks(const Hellos& hellos);

/// What keeps the graph from being complete, in words; empty when it is.
std::string missingInGraph(const std::vector<std::string>& expected_stages, const Hellos& hellos);

/// Throws std::runtime_error naming a topic that two of them publish: the recording has detections, and there
/// is a detector.
void requireOneProducer(const Hellos& hellos);

}  // namespace atlas_loader
