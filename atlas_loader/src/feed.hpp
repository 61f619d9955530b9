// SPDX-License-Identifier: MIT
// Hands an event of a recording to a graph with the type that its stages expect.
#pragma once

#include "atlas/base/local_graph.hpp"
#include "atlas/sensor/record_reader.hpp"

namespace atlas_loader {

inline void feed(atlas::LocalGraph& graph, const atlas::StreamInfo& stream, const atlas::Event& event) {
  if (stream.kind == atlas::StreamKind::kCompressedImage) {
    graph.publish(stream.topic, atlas::EncodedImage{std::get<atlas::ImagePtr>(event.payload)});
    return;
  }
  std::visit([&](const auto& value) { graph.publish(stream.topic, value); }, event.payload);
}

}  // namespace atlas_loader
