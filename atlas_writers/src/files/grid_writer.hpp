// SPDX-License-Identifier: MIT
// grid/<stamp_ns>.pgm and .yaml at a chosen rate, grid/objects.csv with the objects of every update,
// grid/risk.csv with the collision risk of every update.
#pragma once

#include <filesystem>
#include <memory>

#include "atlas/grid/occupancy_products.hpp"
#include "files/output_file.hpp"

namespace atlas {

struct GridWriterParams {
  double period_s = 1.0;  ///< of event time between two grids; 0: every one
};
void validate(const GridWriterParams& params);

class GridWriter {
 public:
  GridWriter(const GridWriterParams& params, const std::filesystem::path& out);
  /// False: not its turn, or without cells.
  bool write(const OccupancyMap& map);
  void write(const Objects& objects);
  /// stamp_ns,known,total,expected_time_s,object,unknown_share; empty where nothing is known.
  void write(const RiskAnswer& answer);
  /// Completes the files; nothing happens a second time.
  void close();

 private:
  std::filesystem::path folder_;
  Duration period_;
  std::optional<Stamp> turn_;  ///< period that was written last
  std::unique_ptr<OutputFile> objects_, risk_;
};

}  // namespace atlas
