// SPDX-License-Identifier: MIT
// A bag as a RecordReader: events ordered by header stamp (bags are stored in order of recording), unusable
// messages counted.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "atlas/sensor/record_reader.hpp"

namespace atlas_ros {

struct BagOptions {
  double start_s = 0.0;             ///< skip this much after the first message
  double duration_s = -1.0;         ///< negative: to the end
  std::vector<std::string> topics;  ///< without leading slash; empty = all
  /// Events may lie this much later in the bag than their stamp says; more is counted as out of order and
  /// left out.
  double reorder_s = 2.0;
};

/// Throws std::runtime_error naming the file when it cannot be opened or is not a bag.
std::unique_ptr<atlas::RecordReader> openBag(const std::string& path, const BagOptions& options);

}  // namespace atlas_ros
