// SPDX-License-Identifier: MIT
// What a stage read, answered and skipped, with reasons. Ends in diagnostics and in run.json: nothing is lost
// silently.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "atlas/base/outcome.hpp"

namespace atlas {

class Counters {
 public:
  void add(const std::string& key, std::uint64_t n = 1) { counts_[key] += n; }
  void skip(const std::string& what, Reason reason, std::uint64_t n = 1) {
    counts_["skipped " + what + ": " + toString(reason)] += n;
  }
  /// The count itself, for loops that must not look it up each time; valid as long as this object.
  std::uint64_t& cell(const std::string& key) { return counts_[key]; }
  [[nodiscard]] std::uint64_t get(const std::string& key) const {
    const auto it = counts_.find(key);
    return it == counts_.end() ? 0 : it->second;
  }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& all() const { return counts_; }

 private:
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace atlas
