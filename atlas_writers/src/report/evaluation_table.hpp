// SPDX-License-Identifier: MIT
// The JSON of evaluate_run as a section of the report: {group: {quantity: number or {count, median, rmse,
// p95, max}}}; a group inside a group is a part of it (one lidar, one camera) and shown on a click.
// "skipped": {reason: count}.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace atlas::report {

/// Order as in the file. Quantities that are not there make no row; empty text when there is nothing at all.
std::string evaluationHtml(const nlohmann::ordered_json& evaluation);

}  // namespace atlas::report
