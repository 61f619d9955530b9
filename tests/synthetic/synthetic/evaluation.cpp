// SPDX-License-Identifier: MIT
#include "synthetic/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace atlas::synthetic {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kColumns[] = {"median", "rmse", "p95", "max"};

/// Nearest rank: the smallest value that at least `share` of all do not exceed.
double quantile(std::vector<float>& values, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

std::string text(const Json& value) {
  char buffer[40];
  if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
  std::snprintf(buffer, sizeof buffer, "%.4g", value.get<double>());
  return buffer;
}

void appendRow(std::string& table, const std::string& name, const Json& value) {
  char row[256];
  if (value.is_object()) {
    std::snprintf(row, sizeof row, "  %-40s", name.c_str());
    table += row;
    for (const char* column : kColumns) {
      std::snprintf(row, sizeof row, "%11s", text(value.at(column)).c_str());
      table += row;
    }
    std::snprintf(row, sizeof row, "%11s\n", text(value.at("count")).c_str());
  } else {
    std::snprintf(row, sizeof row, "  %-40s%11s\n", name.c_str(), text(value).c_str());
  }
  table += row;
}

bool isStatistics(const Json& value) { return value.is_object() && value.contains("median"); }

/// Quantities of a group, then its inner groups.
void appendGroup(std::string& table, const std::string& path, const Json& group) {
  bool titled = false;
  for (const auto& [name, value] : group.items()) {
    if (value.is_object() && !isStatistics(value)) continue;
    if (!titled) table += path + "\n";
    titled = true;
    appendRow(table, name, value);
  }
  for (const auto& [name, value] : group.items()) {
    if (value.is_object() && !isStatistics(value)) appendGroup(table, path + "/" + name, value);
  }
}

}  // namespace

std::optional<ErrorStatistics> statisticsOf(std::vector<float>& errors) {
  if (errors.empty()) return std::nullopt;
  ErrorStatistics result;
  result.count = errors.size();
  double squares = 0;
  for (float& error : errors) {
    error = std::fabs(error);
    squares += static_cast<double>(error) * static_cast<double>(error);
  }
  result.rmse = std::sqrt(squares / static_cast<double>(errors.size()));
  result.median = quantile(errors, 0.5);
  result.p95 = quantile(errors, 0.95);
  result.max = static_cast<double>(*std::max_element(errors.begin(), errors.end()));
  return result;
}

nlohmann::ordered_json& Evaluation::at(const std::string& group) {
  Json* node = &groups_;
  for (std::size_t begin = 0; begin <= group.size();) {
    const std::size_t end = std::min(group.find('/', begin), group.size());
    node = &(*node)[group.substr(begin, end - begin)];
    begin = end + 1;
  }
  return *node;
}

void Evaluation::add(const std::string& group, const std::string& name,
                     const std::optional<ErrorStatistics>& value) {
  if (!value) return;
  at(group)[name] = {{"count", value->count},
                     {"median", value->median},
                     {"rmse", value->rmse},
                     {"p95", value->p95},
                     {"max", value->max}};
}

void Evaluation::add(const std::string& group, const std::string& name, const std::optional<double>& value) {
  if (value) at(group)[name] = *value;
}

void Evaluation::addCount(const std::string& group, const std::string& name, std::uint64_t value) {
  at(group)[name] = value;
}

nlohmann::ordered_json Evaluation::toJson() const {
  Json result = groups_;
  if (!skipped_.empty()) result["skipped"] = skipped_;
  return result;
}

std::string Evaluation::toText() const {
  char title[160];
  std::snprintf(title, sizeof title, "%-42s%11s%11s%11s%11s%11s\n", "quantity", "median", "rmse", "95 %",
                "max", "count");
  std::string table = title;
  for (const auto& [name, group] : groups_.items()) appendGroup(table, name, group);
  for (const auto& [reason, count] : skipped_)
    table += "not compared: " + reason + " (" + std::to_string(count) + ")\n";
  return table;
}

}  // namespace atlas::synthetic
