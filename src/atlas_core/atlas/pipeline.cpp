// SPDX-License-Identifier: MIT
#include "atlas/pipeline.hpp"

namespace atlas {

void addPipeline(LocalGraph& graph, const PipelineParams& params) {
  graph.add([&](LocalGraph::Bus& bus) { return bindMonitor(bus, params.monitor); });
  graph.add([&](LocalGraph::Bus& bus) { return bindLocalization(bus, params.localization); });
  graph.add([&](LocalGraph::Bus& bus) { return bindDeskew(bus, params.deskew); });
  graph.add([&](LocalGraph::Bus& bus) { return bindAggregate(bus, params.aggregate); });
  graph.add([&](LocalGraph::Bus& bus) { return bindObstacles(bus, params.obstacles); });
  if (params.lines) graph.add([&](LocalGraph::Bus& bus) { return bindLines(bus, *params.lines); });
  graph.add([&](LocalGraph::Bus& bus) { return bindCameraLidar(bus, params.camera_lidar); });
  graph.add([&](LocalGraph::Bus& bus) { return bindObjects(bus, params.objects); });
  if (params.stereo) graph.add([&](LocalGraph::Bus& bus) { return bindStereo(bus, *params.stereo); });
  graph.add([&](LocalGraph::Bus& bus) { return bindOccupancy(bus, params.occupancy); });
  graph.add([&](LocalGraph::Bus& bus) { return bindLocalMap(bus, params.local_map); });
  graph.add([&](LocalGraph::Bus& bus) { return bindThermal(bus, params.thermal); });
  graph.beginThread();  // depth images cost as much as all before them
  graph.add([&](LocalGraph::Bus& bus) { return bindDepth(bus, params.depth); });
}

}  // namespace atlas
