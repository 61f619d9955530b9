// SPDX-License-Identifier: MIT
// Damaged stamps: a digit that was lost puts a row years away from its neighbours. Such a row must neither
// move the begin of the record nor be delivered years after its end.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "atlas/base/time.hpp"

namespace atlas::record {

/// Far longer than any recording; clocks that are set during one jump by less.
inline constexpr Duration kLongestRecord = 24 * 3600 * kSecond;
inline constexpr const char* kOutlier = "stamp more than a day from the others of its file";

/// The median; nullopt without any.
std::optional<Stamp> typicalStamp(std::vector<Stamp> stamps);
/// Of the first `max_rows` rows with a stamp in the first column; nullopt without any.
std::optional<Stamp> typicalStamp(const std::filesystem::path& file, std::size_t max_rows);
/// True when both are known and too far from each other.
bool isOutlier(Stamp stamp, const std::optional<Stamp>& typical);

}  // namespace atlas::record
