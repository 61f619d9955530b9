// SPDX-License-Identifier: MIT
#include "files/grid_writer_stage.hpp"

#include <cstdio>

namespace atlas {

GridWriterStage::GridWriterStage(const GridWriterParams& params, const std::filesystem::path& out)
    : Stage("grid_writer", {"grid", "grid/objects", "grid/risk"}), writer_(params, out) {}

GridWriterStage::~GridWriterStage() {
  try {
    writer_.close();
  } catch (const std::exception& error) {  // nothing may leave a destructor
    std::fprintf(stderr, "grid_writer: %s\n", error.what());
  }
}

void GridWriterStage::push(const OccupancyMapPtr& map) {
  enqueue(kGrid, map->stamp, [this, map] {
    if (map->percent.empty())
      counters_.skip("grid", Reason::kNoPoseYet);
    else if (writer_.write(*map))
      counters_.add("grids");
  });
}

void GridWriterStage::push(const ObjectsPtr& objects) {
  enqueue(kObjects, objects->stamp, [this, objects] {
    writer_.write(*objects);
    counters_.add("objects", objects->objects.size());
  });
}

void GridWriterStage::push(const RiskAnswer& risk) {
  enqueue(kRisk, risk.stamp, [this, risk] {
    writer_.write(risk);
    counters_.add("risks");
  });
}

}  // namespace atlas
