// SPDX-License-Identifier: MIT
#include "report/evaluation_table.hpp"

#include "report/html.hpp"
#include "report/number_text.hpp"

namespace atlas::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSkipped = "skipped";

std::string textOf(const Json& value) {
  if (value.is_number_unsigned()) return countText(value.get<std::uint64_t>());
  return value.is_number() ? valueText(value.get<double>()) : "n/a";
}

bool isStatistics(const Json& value) { return value.is_object() && value.contains("median"); }

Table emptyTable() {
  return {{"quantity", "value or median", "RMSE", "95 %", "max", "count", "unit"}, {}, 1};
}

void addQuantity(const std::string& group, const std::string& name, const Json& value, Table& table) {
  const NameAndUnit quantity = splitUnit(name);
  std::vector<std::string> row = {splitUnit(group).name + ": " + quantity.name};
  if (isStatistics(value)) {
    for (const char* key : {"median", "rmse", "p95", "max", "count"})
      row.push_back(value.contains(key) ? textOf(value[key]) : "n/a");
  } else {
    row.push_back(textOf(value));
    row.resize(6);
  }
  row.push_back(quantity.unit);
  table.rows.push_back(row);
}

/// Quantities of the groups of `groups` into `table`, of groups inside them into `parts`.
void addGroups(const Json& groups, const std::string& outer, Table& table, Table& parts) {
  for (const auto& [name, group] : groups.items()) {
    if (!group.is_object() || isStatistics(group) || (outer.empty() && name == kSkipped)) continue;
    const std::string path = outer.empty() ? name : outer + ", " + name;
    for (const auto& [quantity, value] : group.items()) {
      if (!value.is_object() || isStatistics(value)) addQuantity(path, quantity, value, table);
    }
    addGroups(group, path, parts, parts);
  }
}

}  // namespace

std::string evaluationHtml(const Json& evaluation) {
  if (!evaluation.is_object()) return "";
  Table table = emptyTable(), parts = emptyTable();
  addGroups(evaluation, "", table, parts);
  std::string html;
  if (!table.rows.empty()) html += toHtml(table);
  if (!parts.rows.empty()) html += details("by lidar and camera", toHtml(parts));
  if (!evaluation.contains(kSkipped)) return html;
  Table skipped{{"not compared", "count"}, {}, 1};
  for (const auto& [reason, count] : evaluation[kSkipped].items())
    skipped.rows.push_back({reason, textOf(count)});
  return html + details("not compared, and why", toHtml(skipped));
}

}  // namespace atlas::report
