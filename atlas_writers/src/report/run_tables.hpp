// SPDX-License-Identifier: MIT
// Tables of the report from run.json. Missing keys leave out rows, nothing more.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/html.hpp"

namespace atlas::report {

/// Duration, time per second of data, memory, and how much was read.
std::vector<KeyFigure> keyFigures(const nlohmann::json& run, double path_length_m);
/// Events given to the stages, by topic.
Table streamTable(const nlohmann::json& run);
/// Rows of each input file: used, skipped, reasons.
Table fileTable(const nlohmann::json& run);
/// Counters of each stage.
Table stageTable(const nlohmann::json& run);
/// Boxes of each class by part and size, from thermal/card.json.
Table datasetTable(const nlohmann::json& card);
/// What was left out of the dataset, and how often.
Table droppedTable(const nlohmann::json& card);
/// The notes of the run as a list; empty text when there are none.
std::string notesHtml(const nlohmann::json& run);

}  // namespace atlas::report
