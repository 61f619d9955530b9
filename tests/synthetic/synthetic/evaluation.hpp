// SPDX-License-Identifier: MIT
// Errors of a run against the truth, as a table: groups of named quantities. A quantity without data is
// absent, never zero; what could not be compared is counted with its reason. Units are the ends of the names
// (_m, _deg, _percent).
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace atlas::synthetic {

/// Of absolute errors. Quantiles by nearest rank: a value that occurred.
struct ErrorStatistics {
  std::size_t count = 0;
  double median = 0, rmse = 0, p95 = 0, max = 0;
};
/// Reorders `errors` and takes their absolute values; nothing when there are none.
std::optional<ErrorStatistics> statisticsOf(std::vector<float>& errors);

/// A part of a whole; no percentage of nothing.
struct Share {
  std::uint64_t part = 0, whole = 0;
  void add(bool is_part) {
    part += is_part ? 1 : 0;
    ++whole;
  }
  void add(const Share& other) {
    part += other.part;
    whole += other.whole;
  }
  [[nodiscard]] std::optional<double> percent() const {
    if (whole == 0) return std::nullopt;
    return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  }
};

class Evaluation {
 public:
  /// `group` may be nested by '/'. An absent value adds nothing.
  void add(const std::string& group, const std::string& name, const std::optional<ErrorStatistics>& value);
  void add(const std::string& group, const std::string& name, const std::optional<double>& value);
  void addCount(const std::string& group, const std::string& name, std::uint64_t value);
  void skip(const std::string& reason, std::uint64_t count = 1) { skipped_[reason] += count; }

  [[nodiscard]] bool empty() const { return groups_.empty(); }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& skipped() const { return skipped_; }
  /// {group: {name: number or {count, median, rmse, p95, max}}, ..., "skipped": {reason: count}}.
  [[nodiscard]] nlohmann::ordered_json toJson() const;
  /// The same as a table for people.
  [[nodiscard]] std::string toText() const;

 private:
  nlohmann::ordered_json& at(const std::string& group);

  nlohmann::ordered_json groups_ = nlohmann::ordered_json::object();
  std::map<std::string, std::uint64_t> skipped_;
};

}  // namespace atlas::synthetic
