// SPDX-License-Identifier: MIT
// De-skewing done in several ways, right and wrong ones, to measure what the right one is worth and to find
// out which time a recording's stamps mean. Nothing of this is in the data path.
#pragma once

#include <string>
#include <vector>

#include "atlas/base/outcome.hpp"
#include "atlas/base/trajectory.hpp"
#include "atlas/lidar/map_quality.hpp"
#include "atlas/lidar/skew_left.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

enum class DeskewWay {
  kPerPoint,
  kBatches100,
  kNone,         ///< one pose for the whole sweep, at the mean time of its points
  kReversed,     ///< every point at the mirrored time, as if the sensor turned the other way
  kThinnedFirst  ///< the published program: a voxel grid of 0.2 m, which sorts by voxel, and only then 100
                 ///< batches by place in the cloud
};
constexpr DeskewWay kDeskewWays[] = {DeskewWay::kPerPoint, DeskewWay::kBatches100, DeskewWay::kNone,
                                     DeskewWay::kReversed, DeskewWay::kThinnedFirst};
const char* toString(DeskewWay way);

/// The sweep's points in map, in its order; NaN where there was no return or the way left a point out.
/// `stamp_shift` moves the stamp, and with it all points, in time.
[[nodiscard]] Outcome<std::vector<LidarPoint>> placed(const SweepPtr& sweep, DeskewWay way,
                                                      const Trajectory& trajectory, const Pose& T_imu_lidar,
                                                      Duration stamp_shift = 0);

/// Consecutive sweeps put together, one after the other.
[[nodiscard]] Outcome<std::vector<LidarPoint>> placedTogether(const std::vector<SweepPtr>& sweeps,
                                                              DeskewWay way, const Trajectory& trajectory,
                                                              const Pose& T_imu_lidar,
                                                              Duration stamp_shift = 0);

/// Their map quality.
[[nodiscard]] Outcome<MapQuality> qualityOf(const std::vector<SweepPtr>& sweeps, DeskewWay way,
                                            const Trajectory& trajectory, const Pose& T_imu_lidar,
                                            const MapQualityParams& params, Duration stamp_shift = 0);

/// The skew that this way leaves in the map of consecutive sweeps; shifts are the difference between kNone
/// and kPerPoint.
[[nodiscard]] Outcome<SkewLeft> skewLeftOf(const std::vector<SweepPtr>& sweeps, DeskewWay way,
                                           const Trajectory& trajectory, const Pose& T_imu_lidar,
                                           const MapQualityParams& params);

}  // namespace atlas
