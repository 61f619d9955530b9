// SPDX-License-Identifier: MIT
// Streams a record into a bag, messages in order of their stamps. Memory does not grow with the pictures and
// points, only with the index of messages that rosbag keeps (about 60 bytes a message).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "atlas/sensor/record_reader.hpp"

namespace atlas_loader {

struct BagCounts {
  std::map<std::string, std::uint64_t> messages;  ///< by topic
  bool complete = true;                           ///< false when `go_on` has said no
};

/// Writes to `<bag>.part` and renames it at the end; when interrupted, the bag is closed and stays there.
/// go_on(stamp) is asked for every message. Throws std::runtime_error naming the file when it cannot be
/// written or the record has no message at all.
BagCounts writeBag(atlas::RecordReader& reader, const std::string& bag,
                   const std::function<bool(atlas::Stamp)>& go_on);

/// What was written and what became of every row of every file, a line each.
std::vector<std::string> conversionSummary(const atlas::RecordReader& reader, const BagCounts& counts);

}  // namespace atlas_loader
