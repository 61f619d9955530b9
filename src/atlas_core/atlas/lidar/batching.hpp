// SPDX-License-Identifier: MIT
// A sweep cut into N batches, each with the lidar's pose at the mean time of its points (paper IV-B). The cut
// is made on the raw points: after a filter has reordered or thinned them, the place of a point no longer
// tells its time. Sweeps that are stored in order of time are cut into ranges; the others (laser by laser, as
// KITTI) are grouped by time and keep their order.
#pragma once

#include "atlas/base/outcome.hpp"
#include "atlas/base/trajectory.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

/// Point times further than this from the sweep's stamp are garbage: no lidar takes longer for a sweep.
constexpr double kMaxPointTime_s = 1.0;

/// The event time that a sweep covers, its own stamp included.
struct SweepSpan {
  Stamp first = 0, last = 0;
  bool time_ordered = true;  ///< no point is older than the one before it
};
/// kEmpty without points; kNotFinite when a point's time is NaN or beyond kMaxPointTime_s.
[[nodiscard]] Outcome<SweepSpan> spanOf(const Sweep& sweep);

/// The sweep in at most `batches` batches with T_map_lidar = T_map_imu(mean time of the points) *
/// T_imu_lidar, or why a pose is missing. Needs poses over the whole span.
[[nodiscard]] Outcome<BatchedSweep> cutIntoBatches(const SweepPtr& sweep, const SweepSpan& span, int batches,
                                                   const Trajectory& trajectory, const Pose& T_imu_lidar);

}  // namespace atlas
