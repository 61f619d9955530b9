// SPDX-License-Identifier: MIT
// The offline replay: reads events in order and feeds the pipeline and the writers.
#pragma once

#include <string>
#include <vector>

#include "files/run_summary.hpp"
#include "open_input.hpp"

namespace atlas_loader {

struct ReplayOptions {
  InputOptions input;
  std::string out;
  std::string config;              ///< YAML file; "" = packaged
  std::vector<std::string> write;  ///< extra outputs: "deskewed", "lines", "map_colour"
  bool one_thread = false;         ///< instead of several, with the same outputs
  bool stereo = false;             ///< with the stereo pair of the configuration
  bool smooth = false;             ///< two passes: positioning and smoothing first
};

/// Runs to the end of the input, or until interrupted (then the summary is not complete, the outputs are
/// closed and valid). Throws std::invalid_argument for bad options and configurations, std::runtime_error for
/// unreadable input.
atlas::RunSummary replay(const ReplayOptions& options);

}  // namespace atlas_loader
