// SPDX-License-Identifier: MIT
// De-skew of each point by the pose at its own time, the alternative to batches: no step in time is left, and
// what comes out is seen from one pose, so whoever asks for it chains one transform only.
#pragma once

#include "atlas/base/outcome.hpp"
#include "atlas/lidar/batching.hpp"

namespace atlas {

/// The points as seen from the lidar's pose at the sweep's stamp, in one batch with that pose; order, time
/// and NaN are kept. Poses are taken every half millisecond (rotation by slerp) and their matrices
/// interpolated in between, which is exact to some micrometres at a range of 100 m. Needs poses over the
/// whole span.
[[nodiscard]] Outcome<BatchedSweep> deskewPerPoint(const SweepPtr& sweep, const SweepSpan& span,
                                                   const Trajectory& trajectory, const Pose& T_imu_lidar);

}  // namespace atlas
