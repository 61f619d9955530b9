// SPDX-License-Identifier: MIT
// What a stage says about itself on /diagnostics: what it received, answered and skipped, with reasons, and
// what it waits for.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <string>

#include "atlas/base/stage.hpp"

namespace atlas_ros {

/// Names and values of everything that a stage counted: its own counters, `received` and `late` of each
/// input.
std::map<std::string, std::uint64_t> countsOf(const atlas::Stage& stage, const atlas::Counters& unusable);

/// Fills a diagnostic status. OK while nothing is wrong, WARN once something was late or unusable, ERROR
/// after `error`. A skip that the data explains (no pose yet, no points) stays OK. Pure, for tests; `stage`
/// may be null before the first run.
void describeStage(const atlas::Stage* stage, const atlas::Counters& unusable, const std::string& error,
                   diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace atlas_ros
