// SPDX-License-Identifier: MIT
// First of two passes over a recorded run: positioning alone, then smoothing, so that every pose knows the
// measurements after it, too. The second pass de-skews and maps with it.
#pragma once

#include <memory>

#include "atlas/localization/localization_stage.hpp"
#include "open_input.hpp"

namespace atlas_loader {

/// Writes OUT/trajectory/smoothed.tum (and, while it lives, a temporary file in OUT for a long run) and
/// returns the run for LocalizationParams::smoothed. Throws std::invalid_argument for a filter without
/// smoother, std::runtime_error when no pose came out.
std::shared_ptr<const atlas::eskf::History> smoothRun(const InputOptions& input,
                                                      const atlas::LocalizationParams& params,
                                                      const std::string& out);

/// The localization section of a configuration file; "" = the packaged one that fits the input.
atlas::LocalizationParams localizationParams(const std::string& config, const InputOptions& input);

}  // namespace atlas_loader
