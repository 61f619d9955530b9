// SPDX-License-Identifier: MIT
// A sweep as the cameras want it: each looks at every sweep many times and at nothing but the places of
// returns. Half the bytes, in order of batches, coordinates apart so that several points are transformed at
// once.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "atlas/camera/batch_bounds.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct CompactSweep {
  struct Batch {
    Stamp stamp = 0;  ///< when its points were measured
    Pose T_map_lidar;
    BatchBounds bounds;
    std::size_t first = 0, end = 0;  ///< of the points
  };
  Stamp stamp = 0;
  Origin origin;
  std::vector<Batch> batches;  ///< as those of the BatchedSweep
  std::vector<float> x, y, z;  ///< m, lidar frame; finite
};
using CompactSweepPtr = std::shared_ptr<const CompactSweep>;

/// The returns of the sweep; points without return are left out.
[[nodiscard]] CompactSweepPtr compacted(const BatchedSweep& batched, Origin origin = {});
/// The same, shared by all stages that have the sweep and count it alike.
[[nodiscard]] CompactSweepPtr compactedOnce(const BatchedSweep& batched, const Origin& origin);

}  // namespace atlas
