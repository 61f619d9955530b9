// SPDX-License-Identifier: MIT
// Which moment of a sweep the stamps of a recording mark: with the wrong one every sweep is put where the
// vehicle was one sweep earlier or later, and maps of curves and of braking become blurred.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "open_input.hpp"

namespace atlas_loader {

/// What moving all stamps of a lidar by one sweep does to the mean map entropy: mean over the windows of
/// consecutive sweeps and its standard error. Above 0: the stamps as they are fit better.
struct ScanStampFit {
  std::string topic;
  std::size_t windows = 0;
  double earlier = 0, earlier_error = 0;
  double later = 0, later_error = 0;
};

/// Positions the recording (smoothed) and tries the stamps of each lidar. Nothing for lidars that never
/// moved. Throws std::runtime_error for unreadable input.
std::vector<ScanStampFit> tryScanStamps(const InputOptions& input);

/// In words; `is_problem` when other stamps fit better by more than twice the standard error.
struct ScanStampVerdict {
  std::string text;
  bool is_problem = false;
};
ScanStampVerdict judge(const ScanStampFit& fit);

}  // namespace atlas_loader
