// SPDX-License-Identifier: MIT
// Stage: writes what the occupancy filter answers (grid_writer.hpp).
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "atlas/base/local_graph.hpp"
#include "atlas/base/stage.hpp"
#include "files/grid_writer.hpp"

namespace atlas {

class GridWriterStage : public Stage {
 public:
  enum Input : std::size_t { kGrid, kObjects, kRisk };
  GridWriterStage(const GridWriterParams& params, const std::filesystem::path& out);
  ~GridWriterStage() override;
  void push(const OccupancyMapPtr& map);
  void push(const ObjectsPtr& objects);
  void push(const RiskAnswer& risk);

 private:
  void onEnd() override { writer_.close(); }
  GridWriter writer_;
};

template <class Bus>
StageFactory bindGridWriter(Bus& bus, const GridWriterParams& params, const std::string& out) {
  using S = GridWriterStage;
  validate(params);
  bus.template input<S, OccupancyMapPtr>(S::kGrid, "grid", [](S& s, const OccupancyMapPtr& m) { s.push(m); });
  bus.template input<S, ObjectsPtr>(S::kObjects, "grid/objects",
                                    [](S& s, const ObjectsPtr& o) { s.push(o); });
  bus.template input<S, RiskAnswer>(S::kRisk, "grid/risk", [](S& s, const RiskAnswer& r) { s.push(r); });
  return [=] { return std::make_unique<S>(params, out); };
}

}  // namespace atlas
