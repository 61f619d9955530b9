// SPDX-License-Identifier: MIT
#include "report/run_tables.hpp"

#include <optional>

#include "report/number_text.hpp"

namespace atlas::report {
namespace {

using nlohmann::json;

const json& child(const json& value, const std::string& key) {
  static const json kNothing;
  return value.is_object() && value.contains(key) ? value.at(key) : kNothing;
}

std::optional<double> number(const json& value) {
  return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

std::string textOf(const json& value) {
  if (value.is_number_unsigned()) return countText(value.get<std::uint64_t>());
  if (value.is_number()) return valueText(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return value.is_null() ? "n/a" : value.dump();
}

std::string reasonsOf(const json& skipped) {
  std::string text;
  for (const auto& [reason, count] : skipped.items()) {
    text += (text.empty() ? "" : "; ") + reason + ": " + textOf(count);
  }
  return text;
}

std::uint64_t sumOf(const json& counts) {
  std::uint64_t sum = 0;
  for (const auto& [reason, count] : counts.items()) {
    if (count.is_number_unsigned()) sum += count.get<std::uint64_t>();
  }
  return sum;
}

}  // namespace

std::vector<KeyFigure> keyFigures(const json& run, double path_length_m) {
  std::vector<KeyFigure> figures;
  const json& timings = child(run, "timings");
  const auto data_s = number(child(timings, "data_s")), wall_s = number(child(timings, "wall_s"));
  const auto cpu_s = number(child(timings, "cpu_s")), memory_mb = number(child(timings, "peak_rss_mb"));
  if (data_s) figures.push_back({valueText(*data_s) + " s", "of recorded drive"});
  if (path_length_m > 0) figures.push_back({valueText(path_length_m) + " m", "driven"});
  if (wall_s) figures.push_back({valueText(*wall_s) + " s", "to process it"});
  if (data_s && wall_s && *wall_s > 0)
    figures.push_back({valueText(*data_s / *wall_s) + " ×", "faster than real time"});
  if (data_s && cpu_s && *data_s > 0)
    figures.push_back({valueText(*cpu_s / *data_s) + " s", "CPU per second of data"});
  if (memory_mb) figures.push_back({valueText(*memory_mb) + " MB", "peak memory"});
  std::uint64_t events = 0;
  for (const auto& [topic, stream] : child(run, "streams").items()) {
    const json& count = child(stream, "count");
    if (count.is_number_unsigned()) events += count.get<std::uint64_t>();
  }
  if (events > 0) figures.push_back({countText(events), "messages read"});
  return figures;
}

Table streamTable(const json& run) {
  Table table{{"topic", "messages"}, {}, 1};
  for (const auto& [topic, stream] : child(run, "streams").items()) {
    table.rows.push_back({topic, textOf(stream.is_object() ? child(stream, "count") : stream)});
  }
  return table;
}

Table fileTable(const json& run) {
  Table table{{"file, and why rows were skipped", "rows", "used", "skipped"}, {}, 1};
  for (const auto& [name, file] : child(run, "files").items()) {
    const json& skipped = child(file, "skipped");
    const std::string reasons = reasonsOf(skipped);
    table.rows.push_back({name + (reasons.empty() ? "" : ": " + reasons), textOf(child(file, "rows")),
                          textOf(child(file, "used")), countText(sumOf(skipped))});
  }
  return table;
}

Table stageTable(const json& run) {
  Table table{{"stage", "counter", "value"}, {}, 2};
  for (const auto& [stage, counters] : child(run, "stages").items()) {
    for (const auto& [name, value] : counters.items()) table.rows.push_back({stage, name, textOf(value)});
  }
  return table;
}

Table datasetTable(const json& card) {
  Table table{{"class", "train", "val", "test", "small", "medium", "large"}, {}, 1};
  const auto row = [&](const std::string& name, const json& parts, const json& sizes) {
    std::vector<std::string> cells = {name};
    for (const char* part : {"train", "val", "test"}) cells.push_back(textOf(child(parts, part)));
    for (const char* size : {"small", "medium", "large"})
      cells.push_back(sizes.is_null() ? "" : textOf(child(sizes, size)));
    table.rows.push_back(cells);
  };
  if (card.contains("frames")) row("frames", card["frames"], json());
  for (const auto& [name, entry] : child(card, "classes").items())
    row(name, child(entry, "boxes"), child(entry, "sizes"));
  return table;
}

Table droppedTable(const json& card) {
  Table table{{"left out of the dataset", "count"}, {}, 1};
  for (const auto& [what, count] : child(card, "dropped").items())
    table.rows.push_back({what, textOf(count)});
  return table;
}

std::string notesHtml(const json& run) {
  std::string html;
  for (const auto& note : child(run, "notes")) html += "<li>" + escaped(textOf(note)) + "</li>\n";
  return html.empty() ? "" : "<ul>" + html + "</ul>\n";
}

}  // namespace atlas::report
