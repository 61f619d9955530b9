// SPDX-License-Identifier: MIT
// The lazy transforms of a batched sweep carried out (paper IV-B): every point is transformed once, when
// somebody asks.
#pragma once

#include "atlas/sensor/products.hpp"

namespace atlas {

/// The sweep with every point moved to where it was seen from the lidar's pose at the sweep's stamp; NaN
/// stays NaN, and all is NaN when there was no pose. `time` keeps saying when the point was measured.
[[nodiscard]] Sweep deskewed(const BatchedSweep& batched);
/// All points in map, same order as the sweep, NaN kept; all is NaN when there was no pose.
[[nodiscard]] MapCloud inMap(const BatchedSweep& batched);

}  // namespace atlas
