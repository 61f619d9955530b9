// SPDX-License-Identifier: MIT
// Stage: batches of all lidars in, the aggregated cloud of the last seconds out at a chosen rate of event
// time. The points are transformed only now, when somebody asks for them (paper IV-B).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/lidar/sweep_window.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct AggregateParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  double window_s = 1.0;  ///< aggregation time
  double period_s = 1.0;  ///< one cloud per period of event time, on multiples of the period since the epoch
  double voxel_m = 0.2;   ///< leaf of the published cloud; 0 = all points
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const AggregateParams& params);

class AggregateStage : public Stage {
 public:
  explicit AggregateStage(const AggregateParams& params);  ///< input i: batches of params.lidars[i]
  void push(std::size_t lidar, const BatchedSweepPtr& batches);
  /// The sweeps with a stamp in (cloud stamp - window, cloud stamp]. One for each period in which a sweep
  /// with pose came.
  std::function<void(const MapCloudPtr&)> on_cloud;

 protected:
  void onProgress() override;
  void onEnd() override;

 private:
  void take(const BatchedSweepPtr& batches);
  /// Emits the cloud that is due when nothing at or before `known` can come any more.
  void emitDue(Stamp known);

  AggregateParams params_;
  Duration period_;
  SweepWindow window_;
  std::optional<Stamp> next_cloud_;  ///< end of the period of the newest sweep, while its cloud is owed
};

/// All points of the sweeps in map, one per voxel (all when voxel_m is 0), `time` relative to `stamp`; NaN
/// left out.
[[nodiscard]] MapCloud aggregate(const std::deque<BatchedSweepPtr>& sweeps, Stamp stamp, double voxel_m);

}  // namespace atlas
