// SPDX-License-Identifier: MIT
#include "record/stamp_outlier.hpp"

#include <algorithm>

#include "record/text_rows.hpp"

namespace atlas::record {

std::optional<Stamp> typicalStamp(std::vector<Stamp> stamps) {
  if (stamps.empty()) return std::nullopt;
  const auto middle = stamps.begin() + static_cast<std::ptrdiff_t>(stamps.size() / 2);
  std::nth_element(stamps.begin(), middle, stamps.end());
  return *middle;
}

std::optional<Stamp> typicalStamp(const std::filesystem::path& file, std::size_t max_rows) {
  LineReader lines(file);
  RowFields fields("", ',');
  std::vector<Stamp> stamps;
  while (stamps.size() < max_rows) {
    const auto line = lines.next();
    if (!line) break;
    fields.assign(*line);
    const Stamp stamp = fields.stamp(0);
    if (fields.ok()) stamps.push_back(stamp);
  }
  return typicalStamp(std::move(stamps));
}

bool isOutlier(Stamp stamp, const std::optional<Stamp>& typical) {
  return typical && (stamp > *typical + kLongestRecord || stamp < *typical - kLongestRecord);
}

}  // namespace atlas::record
