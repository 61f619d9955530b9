// SPDX-License-Identifier: MIT
// Stage: batches of all lidars in, straight lines along the traces of single lasers and crossings of road
// markings out, once per sweep (the vectorization of the paper). Optional: nothing in the suite rests on it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/sensor/lines.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct LineParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  double max_range_m = 40.0;        ///< farther returns are left out
  double max_gap_m = 0.2;           ///< between neighbouring returns of a laser on one surface, at the lidar
  double max_gap_per_m = 0.02;      ///< added for each metre of range
  int min_points = 10;              ///< of a line
  double min_length_m = 0.5;        ///< of a line that is no marking
  double max_rms_m = 0.04;          ///< distance of the returns from their line: twice the range noise
  double ground_tolerance_m = 0.2;  ///< returns nearer to the ground than this are the road
  double marking_contrast = 2.0;    ///< a marking is so many times as bright as the road around it
  double max_marking_m = 0.8;       ///< along the trace: brighter for longer is another surface
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const LineParams& params);

class LineStage : public Stage {
 public:
  explicit LineStage(const LineParams& params);  ///< input i: batches of params.lidars[i]
  void push(std::size_t lidar, const BatchedSweepPtr& batches);
  /// One per sweep; without lines when it had no pose.
  std::function<void(std::size_t lidar, const Lines&)> on_lines;

 private:
  LineParams params_;
};

/// The lines of one sweep: laser by laser, along each in order of time, markings of a trace after its lines.
[[nodiscard]] Lines findLines(const BatchedSweep& batched, const LineParams& params);

}  // namespace atlas
